#pragma once

#include <optional>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "bags/recorded_tf.h"
#include "bags/stereo_topics.h"
#include "player/recording.h"

namespace rotrocc {

/// A stereo bag, whatever its topics are. Recorded poses of the base are its true path, not tf: the
/// odometry publishes the pose of the base.
class BagRecording : public Recording {
 public:
  /// Throws std::runtime_error if the bag is missing or has no stereo pair, and
  /// std::invalid_argument if its images are raw and the odometry does not rectify.
  explicit BagRecording(const PlayerOptions& options);

  std::string description() const override;
  std::string imageTopic() const override { return image_topic_; }
  std::vector<std::string> notes() const override;
  ros::Time begin() const override { return begin_; }
  ros::Time end() const override { return end_; }
  sensor_msgs::CameraInfo::ConstPtr firstLeftInfo() const override { return first_left_info_; }
  sensor_msgs::CameraInfo::ConstPtr firstRightInfo() const override { return first_right_info_; }
  tf2_msgs::TFMessage staticTransforms() const override { return tf_.staticTransforms(); }
  const nav_msgs::Path& truth() const override { return truth_; }
  Eigen::Isometry3d T_base_camera() const override { return tf_.T_base_camera(); }
  void select(const ros::Time& from, const ros::Time& to) override;
  bool next(RecordedMessage& message) override;

 private:
  bool read(const rosbag::MessageInstance& instance, RecordedMessage& message) const;

  std::string path_;
  rosbag::Bag bag_;
  StereoTopics topics_;
  std::string image_topic_;
  RecordedTf tf_;
  nav_msgs::Path truth_;
  sensor_msgs::CameraInfo::ConstPtr first_left_info_;
  sensor_msgs::CameraInfo::ConstPtr first_right_info_;
  ros::Time begin_;
  ros::Time end_;
  std::optional<rosbag::View> selected_;
  rosbag::View::iterator next_;
};

}  // namespace rotrocc
