#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/Imu.h>
#include <Eigen/Geometry>

#include "inertial/gyro_predictor.h"
#include "inertial/vertical.h"
#include "input/callback_thread.h"
#include "input/log.h"
#include "node/health/diagnostics.h"
#include "node/miss_backoff.h"
#include "node/tf/sensor_mount.h"
#include "rotrocc/OdometryStatus.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Rotations of the camera from the topic imu, and the vertical. It is received in a thread of its
/// own, so that images do not delay it. Its mount on the base is that of tf, as the camera's is, so
/// either of them may move. Logs when it is used, and when not and why, after kPairs in a row.
/// Samples of one that has been missing for a while are waited for only now and then.
class GyroInput {
 public:
  static constexpr int kPairs = MissBackoff::kMisses;
  /// While it is missing, one of so many pairs waits for it.
  static constexpr int kRetryPairs = 10;

  /// Subscribes. A pair waits for its samples for at most 20 ms of real time, and for the
  /// mount for mount_timeout_s.
  GyroInput(const ros::NodeHandle& nh, const NodeParameters& parameters, Log log);
  ~GyroInput();
  GyroInput(const GyroInput&) = delete;
  GyroInput& operator=(const GyroInput&) = delete;

  // For one thread:

  /// Looks up the mount at a pair, where that of the camera is known. To be called with each one.
  void follow(std::int64_t stamp_ns, const Eigen::Isometry3d& T_base_camera);
  /// A fixed mount is looked up again.
  void lookAgain() { mount_.lookAgain(); }

  /// R_from_to of the camera between two pairs, if samples of that time are there in time, and the
  /// mount is known at both.
  std::optional<Eigen::Matrix3d> rotation(std::int64_t from_ns, std::int64_t to_ns);

  /// Whether a first pair shall wait for tf and the accelerations of a second, which it does for
  /// two seconds of real time at most.
  bool waitsForVertical(std::int64_t stamp_ns);

  /// The vertical in axes of the camera at a pair, if it is known. Logs why not.
  std::optional<Eigen::Vector3d> up(std::int64_t stamp_ns);

  /// To be called with the result of each pair. Sets the fields of the gyroscope.
  void observe(const OdometryResult& result, OdometryStatus& status);
  /// The entry of /diagnostics.
  void describe(StatusWrapper& status) const;

 private:
  void receive(const sensor_msgs::Imu& message);
  std::optional<std::string> whyNoMount(std::int64_t from_ns, std::int64_t to_ns);
  void tell(bool used);

  Log log_;
  std::string base_frame_;
  SensorMount mount_;
  std::map<std::int64_t, Eigen::Matrix3d> R_camera_gyro_;  // at the stamps of recent pairs

  mutable std::mutex mutex_;  // of what follows, up to the empty line
  std::condition_variable received_;
  GyroPredictor predictor_;
  Vertical vertical_;
  std::optional<std::chrono::steady_clock::time_point> vertical_wait_;  // since then
  MissBackoff backoff_{kRetryPairs};
  bool was_used_ = false;
  int in_a_row_ = 0;               // pairs that it was used, or was not
  std::optional<bool> told_used_;  // as the log says
  std::string gyro_frame_;         // of the last message
  bool was_asked_ = false;         // for the rotation of this pair

  CallbackThread callbacks_;
  ros::Subscriber subscriber_;
};

}  // namespace rotrocc
