#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "stress/answer_audit.h"
#include "stress/fault_injector.h"
#include "support/background_command.h"
#include "support/service_caller.h"
#include "support/temporary_directory.h"

namespace rotrocc {

struct StressOptions {
  std::string recording;      ///< bag or sequence, played forwards and backwards in a loop
  double rate_hz = 10.0;      ///< of the pairs
  double duration_s = 60.0;   ///< of the whole run
  double fault_share = 0.05;  ///< of the pairs that get a fault; 0: none, and no restart of stamps
  bool in_turn = false;       ///< each fault once instead, the next after a recovery
  std::string guess_frame;    ///< parent of base_link in tf, from the true path; empty: no tf
  unsigned seed = 1;          ///< same seed, same faults
};

/// Plays a recording to an odometry in a loop, forwards and backwards, with faults; tf of the
/// camera comes late, and a subscriber is slow. With faults at random, all services are called and
/// the stamps restart with each loop. In turn, the stamps are those of the clock.
class StressPlayer {
 public:
  /// Throws std::runtime_error on a recording that cannot be used.
  StressPlayer(ros::NodeHandle& nh, const StressOptions& options);

  /// Prints the report; returns whether the test passed.
  bool run();

  const FaultInjector& faults() const { return faults_; }
  const AnswerAudit& audit() const { return audit_; }

 private:
  void read();
  void waitForOdometry();
  bool ended() const;
  bool mayBegin() const;
  void send(std::size_t index, ros::Time& stamp);
  void publish(const StressPair& pair);
  void pauseAfter(const StressPair& pair);
  void settle(ros::Time& stamp);
  bool tfIsLate() const;
  void publishMount(double height_m = 0.0);
  void publishTf(const StressPair& pair, std::size_t index, const ros::Time& stamp);
  void callServices();
  void save(const std::string& path);

  StressOptions options_;
  std::vector<StressPair> recording_;
  nav_msgs::Path truth_;
  StressPair sent_;     // last
  ros::Duration step_;  // of the stamps, as recorded whatever the rate: the speed stays plausible
  FaultInjector faults_;
  AnswerAudit audit_;
  ServiceCaller services_;
  std::uint64_t calls_ = 0, failed_calls_ = 0;
  std::chrono::steady_clock::time_point begin_, next_, end_, fault_end_;
  int burst_left_ = 0;
  bool was_faulty_ = false;
  unsigned pairs_sent_ = 0;
  bool has_mount_ = false;
  TemporaryDirectory directory_;
  std::string fifo_ = directory_ / "fifo";
  std::optional<BackgroundCommand> slow_subscriber_;

  tf2_ros::StaticTransformBroadcaster mount_broadcaster_;
  tf2_ros::TransformBroadcaster tf_broadcaster_;
  ros::Publisher left_image_, right_image_, left_info_, right_info_;
};

}  // namespace rotrocc
