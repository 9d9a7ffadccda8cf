#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nav_msgs/Path.h>
#include <ros/time.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <opencv2/core.hpp>

#include "inertial/gyro_sample.h"
#include "rotrocc/kitti.h"

namespace rotrocc {

/// Writes a KITTI sequence as a bag:
///   /stereo/{left,right}/image_rect    sensor_msgs/Image, mono8
///   /stereo/{left,right}/camera_info   sensor_msgs/CameraInfo
///   /tf_static                         base_link -> stereo_left_optical, see kittiMount()
///   /ground_truth/path                 nav_msgs/Path of base_link in odom, once, if known
///   /ground_truth/pose                 geometry_msgs/PoseStamped, one per pair
///   /imu/data                          sensor_msgs/Imu in imu_link, whose axes are those of
///   base_link;
///                                      the angular velocity only, if imu.csv of the sequence has
///                                      it
/// Images and infos of both cameras are in the frame of the left one: P of a rectified pair refers
/// to it (sensor_msgs/CameraInfo), and image_geometry requires equal frames.
class KittiBagWriter {
 public:
  /// The first pair of a sequence gets the stamp `start_time_s` plus its time in the sequence.
  /// Writes into `path`.part until finish(). Throws std::invalid_argument if the stamps are out of
  /// range, std::runtime_error if the file cannot be written.
  KittiBagWriter(const std::string& path, const KittiSequence& sequence, std::int64_t start_time_s);

  /// Removes an unfinished file.
  ~KittiBagWriter();
  KittiBagWriter(const KittiBagWriter&) = delete;
  KittiBagWriter& operator=(const KittiBagWriter&) = delete;

  /// Call for each pair of the sequence, in order.
  void writePair(int index);

  /// Renames the complete file to its final name.
  void finish();

 private:
  ros::Time stamp(int index) const;
  void beginStamp(const ros::Time& stamp);
  void writeStatic();
  void writeGyroscope(const ros::Time& end);
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
  std::vector<GyroSample> gyroscope_;  // in axes of the left camera
  std::size_t next_sample_ = 0;
  rosbag::Bag bag_;
  ros::Time stamp_;
  ros::Time record_time_;
  bool finished_ = false;
};

}  // namespace rotrocc
