#pragma once

#include <cstdint>
#include <string>

#include <nav_msgs/Path.h>
#include <ros/time.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <opencv2/core.hpp>

#include "rotrocc/kitti.h"

namespace rotrocc {

/// Writes a KITTI sequence as a bag:
///   /stereo/{left,right}/image_rect    sensor_msgs/Image, mono8
///   /stereo/{left,right}/camera_info   sensor_msgs/CameraInfo
///   /tf_static                         base_link -> stereo_left_optical, see kittiMount()
///   /ground_truth/path                 nav_msgs/Path of base_link in odom, once, if there are
///   poses /ground_truth/pose                 geometry_msgs/PoseStamped, its poses one by one
/// Images and infos of both cameras are in the frame of the left one: that is what the P of a
/// rectified pair refers to (sensor_msgs/CameraInfo), and image_geometry wants the two frames
/// alike.
class KittiBagWriter {
 public:
  /// The first pair of a sequence gets the stamp `start_time_s` plus its time in the sequence.
  /// Writes into `path`.part until finish(). Throws std::invalid_argument if ROS has no such
  /// stamps, std::runtime_error if the file cannot be written.
  KittiBagWriter(const std::string& path, const KittiSequence& sequence, std::int64_t start_time_s);

  /// Removes what is not finished.
  ~KittiBagWriter();
  KittiBagWriter(const KittiBagWriter&) = delete;
  KittiBagWriter& operator=(const KittiBagWriter&) = delete;

  /// To be called for each pair of the sequence in its order.
  void writePair(int index);

  /// Gives the complete file its name.
  void finish();

 private:
  ros::Time stamp(int index) const;
  void beginStamp(const ros::Time& stamp);
  void writeStatic();
  void writeCamera(const std::string& camera_topic,
                   sensor_msgs::CameraInfo info,
                   const cv::Mat& image);
  template <typename Message>
  void write(const std::string& topic, const Message& message);

  std::string path_;
  std::string unfinished_path_;
  const KittiSequence& sequence_;
  std::int64_t start_time_s_;
  nav_msgs::Path ground_truth_;
  rosbag::Bag bag_;
  ros::Time stamp_;
  ros::Time record_time_;
  bool finished_ = false;
};

}  // namespace rotrocc
