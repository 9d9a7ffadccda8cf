#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <Eigen/Geometry>

#include "input/log.h"
#include "node/waiting.h"

namespace rotrocc {

/// Pose of a sensor on the robot, from tf.
///
/// A pose from /tf_static alone is fixed: the first one is kept, because a change would look like a
/// motion of the sensor; another one is a problem until refresh(). Other poses are looked up at
/// each stamp, and pairs wait for late transforms. If one does not arrive in time, a sensor that
/// has not moved so far is assumed fixed, and pairs no longer wait until it moves; the pose of a
/// sensor that moves is then unknown.
class SensorPose {
 public:
  /// Waits at most `timeout_s` for a transform at a stamp. Without a log, it is silent.
  SensorPose(const tf2::BufferCore& tf,
             const std::string& base_frame,
             double timeout_s,
             const std::optional<Log>& log = Log());

  /// T_base_sensor at a stamp; nothing if tf has none, see missing(), or none in time, see
  /// problem(). Logs the first pose, that it moves, a new frame, a problem and, after repeated
  /// calls, that tf has none.
  std::optional<Eigen::Isometry3d> find(const std::string& frame,
                                        std::int64_t stamp_ns,
                                        const WaitFor& wait);

  /// The next find() looks up a fixed pose again, as after a new calibration.
  void refresh();

  /// The transform that tf does not have, in one sentence; empty if it does.
  const std::string& missing() const { return missing_; }

  /// In one sentence with a remedy; empty if there is none: that transforms of a sensor that moves
  /// recently did not come in time, or so late that newer images came, with the rate of tf; or that
  /// /tf_static has another pose than the first one.
  const std::string& problem() const { return problem_; }

 private:
  void lookFor(const std::string& frame);
  std::optional<Eigen::Isometry3d> lookUp(const ros::Time& stamp, const WaitFor& wait);
  geometry_msgs::TransformStamped transformAt(const ros::Time& stamp) const;
  void watchMovement(const Eigen::Isometry3d& T_base_sensor);
  void watchFixed();
  void logPose(const Eigen::Isometry3d& T_base_sensor);
  std::string describeLate(bool comes) const;
  std::optional<double> rate_hz() const;

  const tf2::BufferCore& tf_;
  std::optional<Log> log_;
  std::string base_frame_;
  double timeout_s_;
  std::string frame_;
  std::string previous_frame_;  // empty until it changes
  std::optional<Eigen::Isometry3d> T_base_sensor_;
  Eigen::Isometry3d T_base_sensor_first_ = Eigen::Isometry3d::Identity();
  bool fixed_ = false;
  bool moves_ = false;
  bool waits_ = true;  // unless it moves
  ros::Time last_stamp_;
  double period_s_ = 0.0;  // from the stamp before
  int in_time_ = 0;        // transforms in a row
  std::string problem_;
  std::string missing_;
  std::optional<std::chrono::steady_clock::time_point> missing_since_;
  Throttle description_{std::chrono::seconds(1)};
  Throttle warning_;
  Throttle late_warning_;
  Throttle change_warning_;
};

/// Throws std::invalid_argument with the value if a number is not finite, or the length of the
/// quaternion differs from 1 by more than 1 %.
Eigen::Isometry3d toEigen(const geometry_msgs::Transform& transform);

/// "at 0 0 1.65 m, looks along +x (forward), its image is upright": for a user to check the pose of
/// a camera.
std::string describeCameraPose(const Eigen::Isometry3d& T_base_camera);

}  // namespace rotrocc
