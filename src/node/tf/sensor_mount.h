#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <Eigen/Geometry>

#include "input/log.h"
#include "node/tf/tf_feed.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// Pose of a sensor on the robot, from tf.
///
/// A mount from /tf_static alone is looked up once, and then tf is no longer listened to, until
/// lookAgain(): a mount that changes without it would look like a motion of the sensor. Other
/// mounts are looked up at each stamp, and late transforms are waited for. If one does not come in
/// time, a mount that has not moved so far is assumed at rest, and no longer waited for until it
/// moves. One that moves is extrapolated, as its motion was just before, with an error as large as
/// that motion.
class SensorMount {
 public:
  /// Waits at most `timeout_s` for a transform at a stamp, and extrapolates by no more than that.
  /// Without a log, it is silent.
  SensorMount(const std::string& base_frame,
              double timeout_s,
              TfFeed feed = listenToTf,
              const std::optional<Log>& log = Log());
  SensorMount(const SensorMount&) = delete;
  SensorMount& operator=(const SensorMount&) = delete;

  /// T_base_sensor at a stamp; nothing if tf does not have it. Logs the pose of the camera, that it
  /// moves, a new frame, transforms that are slow or late and, after repeated calls, missing ones.
  std::optional<UncertainTransform> find(const std::string& frame, std::int64_t stamp_ns);

  /// The next find() looks the mount up again, also a fixed one, as it is after a new calibration.
  void lookAgain();

  /// The transform that find() is missing, in one sentence; empty if found.
  const std::string& missing() const { return missing_; }

  /// Why a mount that moves was recently extrapolated, missing, or waited for while newer pairs
  /// came, in one sentence with a remedy; empty if it was not.
  const std::string& trouble() const { return trouble_; }

 private:
  void lookFor(const std::string& frame);
  UncertainTransform lookUp(const ros::Time& stamp);
  geometry_msgs::TransformStamped latest();
  bool knowsPeriod() const;
  bool comesInTime(const ros::Time& stamp) const;
  UncertainTransform extrapolate(const ros::Time& stamp) const;
  Eigen::Isometry3d fix(const Eigen::Isometry3d& T_base_sensor);
  void watchMovement(const Eigen::Isometry3d& T_base_sensor);
  void tellMount(const Eigen::Isometry3d& T_base_sensor);
  void onMissing(const std::string& why);
  void onSlow(const ros::Time& stamp, double limit_s);
  void endTrouble();
  geometry_msgs::TransformStamped transformAt(const ros::Time& stamp) const;

  std::optional<Log> log_;
  std::string base_frame_;
  double timeout_s_;
  TfFeed feed_;
  std::string frame_;
  std::string previous_frame_;  // empty until it changes
  std::optional<UncertainTransform> T_base_sensor_;
  Eigen::Isometry3d T_base_sensor_first_ = Eigen::Isometry3d::Identity();
  bool fixed_ = false;  // by /tf_static
  bool moves_ = false;
  bool waits_ = true;  // unless it moves
  ros::Time last_stamp_;
  double interval_s_ = 0.0;  // from the stamp before

  ros::Time latest_;                // of tf, when it was looked up last; zero: not yet
  std::optional<double> step_s_;    // from the one before
  std::optional<double> period_s_;  // the shorter of the last two steps
  int new_in_a_row_ = 0;            // calls with a new one
  int exact_ = 0;                   // stamps in a row that had a transform in time
  int slow_ = 0;                    // stamps, until there were enough exact ones
  ros::Time last_slow_;
  std::string trouble_;

  std::string missing_;
  std::optional<std::chrono::steady_clock::time_point> missing_since_;
  Throttle warning_;
  Throttle change_warning_;
  std::unique_ptr<tf2::BufferCore> buffer_;
  std::shared_ptr<void> listener_;  // until a fixed mount is found
};

/// Throws std::invalid_argument with the value if a number is not finite, or the length of the
/// quaternion differs from 1 by more than 1 %.
Eigen::Isometry3d toEigen(const geometry_msgs::Transform& transform);

/// "at 0 0 1.65 m, looks along +x (forward), its image is upright": for a user to check the camera
/// pose.
std::string describeMount(const Eigen::Isometry3d& T_base_camera);

}  // namespace rotrocc
