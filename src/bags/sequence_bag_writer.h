#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <nav_msgs/Path.h>
#include <ros/time.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <opencv2/core.hpp>

#include "rectification/stereo_rectifier.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {

/// Writes a sequence as a bag:
///   /stereo/{left,right}/image_rect    sensor_msgs/Image, mono8; image_raw if they are not
///   rectified /stereo/{left,right}/camera_info   sensor_msgs/CameraInfo: of raw images with their
///   K, D and R /tf_static                         base_link -> stereo_left_optical: the rectified
///   left camera /ground_truth/path                 nav_msgs/Path of base_link in odom, once, if
///   known /ground_truth/pose                 geometry_msgs/PoseStamped, one per pair that has one
///   /imu/data                          sensor_msgs/Imu in imu_link, whose axes are those of
///                                      base_link; the angular velocity only, if there is one
/// Images and infos of both cameras are in the frame of the left one: P of a rectified pair refers
/// to it (sensor_msgs/CameraInfo), and image_geometry requires equal frames.
class SequenceBagWriter {
 public:
  struct Options {
    /// Time of the first pair of a sequence whose stamps are since 1970, otherwise of its time 0;
    /// by default as it is, or kKittiStart_s.
    std::optional<std::int64_t> start_time_s;
    bool rectify = false;  ///< images that are not rectified
  };

  /// Writes into `path`.part until finish(). Throws std::invalid_argument if the stamps are out of
  /// range, std::runtime_error if the file cannot be written.
  SequenceBagWriter(const std::string& path, StereoSequence& sequence, const Options& options);

  /// Removes an unfinished file.
  ~SequenceBagWriter();
  SequenceBagWriter(const SequenceBagWriter&) = delete;
  SequenceBagWriter& operator=(const SequenceBagWriter&) = delete;

  /// Call for each pair of the sequence, in order.
  void writePair(int index);

  /// Renames the complete file to its final name.
  void finish();

 private:
  ros::Time stamp(std::int64_t stamp_ns) const;
  void beginStamp(const ros::Time& stamp);
  void writeStatic();
  void writeTruth();
  void writeGyroscope(const ros::Time& end);
  void writeCamera(const std::string& side, sensor_msgs::CameraInfo info, const cv::Mat& image);
  template <typename Message>
  void write(const std::string& topic, const Message& message);

  std::string path_;
  std::string unfinished_path_;
  StereoSequence& sequence_;
  std::int64_t offset_ns_;
  StereoCalibration calibration_;  // of the images in the bag
  std::optional<StereoRectifier> rectifier_;
  nav_msgs::Path ground_truth_;
  std::size_t next_truth_ = 0;
  GyroRecording gyroscope_;
  std::size_t next_sample_ = 0;
  rosbag::Bag bag_;
  ros::Time stamp_;
  ros::Time record_time_;
  bool finished_ = false;
};

/// Writes all pairs.
void writeSequenceBag(const std::string& path,
                      StereoSequence& sequence,
                      const SequenceBagWriter::Options& options = {});

}  // namespace rotrocc
