#pragma once

#include <optional>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bags/recorded_tf.h"
#include "bags/recording.h"
#include "bags/stereo_topics.h"

namespace rotrocc {

/// A stereo bag, whatever its topics are. Recorded poses of the base are its true path, not tf: the
/// odometry publishes the pose of the base.
class BagRecording : public Recording {
 public:
  /// Throws std::runtime_error if the file is not a bag, or has no stereo pair.
  BagRecording(const std::string& path, const RecordingOptions& options);

  std::string description() const override;
  int size() const override;
  /// Whether a topic is not one of rectified images, and the first camera_info describes raw ones.
  bool isRaw() const override;
  std::vector<std::string> notes() const override;
  ros::Time begin() const override { return begin_; }
  ros::Time end() const override { return end_; }
  sensor_msgs::CameraInfo::ConstPtr firstLeftInfo() const override { return first_left_info_; }
  sensor_msgs::CameraInfo::ConstPtr firstRightInfo() const override { return first_right_info_; }
  tf2_msgs::TFMessage staticTransforms() const override { return tf().staticTransforms(); }
  nav_msgs::Path truth() const override;
  Eigen::Isometry3d T_base_camera() const override { return tf().T_base_camera(); }
  GyroRecording gyroscope(const std::string& topic) const override;
  void select(const ros::Time& from, const ros::Time& to, bool with_tf) override;
  bool next(RecordedMessage& message) override;

 private:
  const RecordedTf& tf() const;
  bool read(const rosbag::MessageInstance& instance, RecordedMessage& message) const;

  std::string path_;
  rosbag::Bag bag_;
  std::string base_frame_;
  StereoTopics topics_;
  std::string camera_frame_;
  mutable std::optional<RecordedTf> tf_;  // read when it is needed: there may be much of it
  sensor_msgs::CameraInfo::ConstPtr first_left_info_;
  sensor_msgs::CameraInfo::ConstPtr first_right_info_;
  ros::Time begin_;
  ros::Time end_;
  std::optional<rosbag::View> selected_;
  rosbag::View::iterator next_;
};

}  // namespace rotrocc
