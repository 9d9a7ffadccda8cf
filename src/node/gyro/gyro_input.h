#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <sensor_msgs/Imu.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "inertial/gyro_predictor.h"
#include "inertial/vertical.h"
#include "input/log.h"
#include "node/health/diagnostics.h"
#include "node/miss_backoff.h"
#include "rotrocc/OdometryStatus.h"
#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Rotations of the camera from the topic imu, and the vertical. It is received in a thread of its
/// own, so that images do not delay it. The mount is looked up in tf once, for each frame of the
/// camera and of the messages. Logs when it is used, and when not and why, after kPairs in a row.
/// Samples of one that has been missing for a while are waited for only now and then.
class GyroInput {
 public:
  static constexpr int kPairs = MissBackoff::kMisses;
  /// While it is missing, one of so many pairs waits for it.
  static constexpr int kRetryPairs = 10;

  /// Subscribes. A pair waits for its samples for at most `timeout_s`, in real time.
  GyroInput(const ros::NodeHandle& nh, double timeout_s, Log log);
  ~GyroInput();
  GyroInput(const GyroInput&) = delete;
  GyroInput& operator=(const GyroInput&) = delete;

  /// R_from_to of the camera, if samples of that time and tf are there in time. For one thread.
  std::optional<Eigen::Matrix3d> rotation(const std::string& camera_frame,
                                          std::int64_t from_ns,
                                          std::int64_t to_ns);

  /// Whether a first pair shall wait for tf and the accelerations of a second, which it does for
  /// two seconds of real time at most.
  bool waitsForVertical(const std::string& camera_frame);

  /// The vertical in axes of the camera, if it is known. Logs why not.
  std::optional<Eigen::Vector3d> up(const std::string& camera_frame, std::int64_t stamp_ns);

  /// To be called with the result of each pair.
  void observe(const OdometryResult& result);

  /// Sets the fields of the gyroscope.
  void report(OdometryStatus& status) const;
  /// The entry of /diagnostics.
  void describe(StatusWrapper& status) const;

 private:
  void receive(const sensor_msgs::Imu& message);
  std::string whyNoMount(const std::string& camera_frame);
  void tell(bool used);

  Log log_;
  std::chrono::duration<double> timeout_;

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
  std::string mounted_on_;         // camera frame and gyroscope frame of the mount; empty: unknown
  bool was_asked_ = false;         // for the rotation of this pair

  tf2_ros::Buffer tf_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;  // until the mount is known
  ros::CallbackQueue queue_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace rotrocc
