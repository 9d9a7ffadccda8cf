#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include "input/input_error.h"
#include "input/latest_mailbox.h"
#include "input/log.h"
#include "node/base/pair_processor.h"
#include "node/gyro/gyro_input.h"
#include "node/health/diagnostics.h"
#include "node/health/loss_log.h"
#include "node/health/odometry_health.h"
#include "node/live_parameters.h"
#include "node/odometry_publisher.h"
#include "node/odometry_services.h"
#include "node/stereo_input.h"
#include "node/tf/guess_odometry.h"
#include "node/tf/guess_topic.h"
#include "node/tf/sensor_pose.h"
#include "node/tf/tf_conflict.h"
#include "node/tf/tf_receiver.h"
#include "node/trajectory_store.h"
#include "rotrocc/parameters.h"

namespace rotrocc {

/// Live stereo odometry: stereo images in, nav_msgs/Odometry and tf out.
///
/// docs/node.md lists topics and services, config/default.yaml the private parameters.
///
/// The callbacks only match images to pairs. A worker thread processes them; if it is too slow, it
/// skips to the newest pair. It gathers what is known of a pair, estimates the motion, sends tf and
/// odometry, and does all else after that.
class StereoOdometry {
 public:
  /// Throws std::exception if it cannot start; then nothing of it is left. `name` is that of the
  /// node or nodelet, for logs.
  StereoOdometry(ros::NodeHandle& nh,
                 ros::NodeHandle& private_nh,
                 const std::string& name,
                 const Parameters& parameters);
  ~StereoOdometry();

 private:
  using Time = std::chrono::steady_clock::time_point;

  /// A pair that is ready for the estimator.
  struct Gathered {
    PairInput in;
    std::string camera_frame;
    Time converted, complete;
  };

  // In the thread of the nodelet.
  void onPair(ReceivedPair pair);
  void onTick(const ros::WallTimerEvent& event);

  // In the worker thread.
  void work();
  void process(const ReceivedPair& received);
  std::optional<Gathered> gather(const ReceivedPair& received);
  void report(const PairInput& in, const PairAnswer& answer, PairReport report);
  bool waitFor(double limit_s, const std::function<bool()>& condition) const;
  bool isRunning() const;

  Log log_;
  NodeParameters parameters_;
  DropLog drops_;
  OdometryHealth health_;
  PairProcessor processor_;
  std::unique_ptr<TfConflict> tf_conflict_;  // unless publish_tf is false
  TfReceiver tf_;
  SensorPose camera_pose_;
  std::optional<GuessTopic> guess_topic_;
  std::optional<GuessOdometry> guess_;
  std::optional<GyroInput> gyro_;
  OdometryPublisher publisher_;
  TrajectoryStore trajectory_;

  LossLog loss_log_;  // of the worker
  // Of the callbacks.
  FaultThrottle warning_;

  LatestMailbox<ReceivedPair> mailbox_;
  // Order matters from here on: members are destroyed after those that call them.
  std::optional<StereoInput> input_;
  std::optional<Diagnostics> diagnostics_;
  std::optional<OdometryServices> services_;
  std::optional<LiveParameters> live_parameters_;
  ros::WallTimer ticker_;
  std::thread worker_;
};

}  // namespace rotrocc
