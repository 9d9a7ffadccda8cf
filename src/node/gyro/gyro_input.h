#pragma once

#include <chrono>
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
#include "input/callback_thread.h"
#include "input/log.h"
#include "node/gyro/vertical.h"
#include "node/health/diagnostics.h"
#include "node/tf/sensor_pose.h"
#include "node/waiting.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Rotations of the camera from the topic imu, and the vertical. It is received in a thread of its
/// own, so that images do not delay it. Its pose on the base is that of tf, as the camera's is, so
/// either of them may move. Logs when it is used, and when not and why, after SourceWatch::kPairs
/// in a row. Samples of one that has been missing for a while are waited for only now and then.
class GyroInput {
 public:
  /// While it is missing, one of so many pairs waits for it.
  static constexpr int kRetryPairs = 10;

  /// How long a pair waits for its samples, in real time: a driver sends them within some
  /// milliseconds, and the gyroscope is worth no more delay.
  static constexpr double kTimeout_s = 0.02;

  /// Subscribes.
  GyroInput(const ros::NodeHandle& nh,
            const tf2::BufferCore& tf,
            const NodeParameters& parameters,
            Log log);

  // For one thread:

  /// Waits for the samples up to a pair, and for the pose of the gyroscope there. Call it with
  /// each pair; `T_base_camera` is that of the camera.
  void gather(std::int64_t stamp_ns, const Eigen::Isometry3d& T_base_camera, const WaitFor& wait);
  /// A fixed pose is looked up again.
  void refresh() { pose_.refresh(); }

  /// R_from_to of the camera between two pairs, if samples of that time are there, and the poses
  /// are known at both.
  std::optional<Eigen::Matrix3d> rotation(std::int64_t from_ns, std::int64_t to_ns);

  /// Whether a first pair shall wait for tf and the accelerations of a second, which it does for
  /// two seconds of real time at most.
  bool waitsForVertical(std::int64_t stamp_ns);

  /// The vertical in axes of the camera at a pair, if it is known. Logs why not.
  std::optional<Eigen::Vector3d> up(std::int64_t stamp_ns);

  /// Call with the result of each pair. Sets what the status says of rotations.
  void observe(const OdometryResult& result, OdometryStatus& status);
  /// The entry of /diagnostics.
  void describe(StatusWrapper& status) const;

 private:
  void receive(const sensor_msgs::Imu& message);
  std::optional<std::string> whyNoPose(std::int64_t from_ns, std::int64_t to_ns);

  Log log_;
  std::string base_frame_;
  SensorPose pose_;
  std::map<std::int64_t, Eigen::Matrix3d> R_camera_gyro_;  // at the stamps of recent pairs

  mutable std::mutex mutex_;  // of what follows, up to the empty line
  GyroPredictor predictor_;
  Vertical vertical_;
  std::optional<std::chrono::steady_clock::time_point> vertical_wait_;  // since then
  SourceWatch watch_{kRetryPairs};
  std::string gyro_frame_;  // of the last message
  bool was_asked_ = false;  // for the rotation of this pair

  CallbackThread callbacks_;
  ros::Subscriber subscriber_;  // last, so that callbacks end before the others are destroyed
};

}  // namespace rotrocc
