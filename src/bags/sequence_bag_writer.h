#pragma once

#include <cstddef>
#include <string>

#include <ros/time.h>
#include <rosbag/bag.h>

#include "bags/sequence_messages.h"
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
class SequenceBagWriter {
 public:
  using Options = SequenceMessages::Options;

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
  void beginStamp(const ros::Time& stamp);
  void writeStatic();
  void writeTruth();
  void writeGyroscope(const ros::Time& end);
  void writeCamera(const std::string& side, const SequenceMessages::Camera& camera);
  template <typename Message>
  void write(const std::string& topic, const Message& message);

  std::string path_;
  std::string unfinished_path_;
  SequenceMessages messages_;
  std::size_t next_truth_ = 0;
  int next_sample_ = 0;
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
