#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/time.h>
#include <rosgraph_msgs/Log.h>

#include "node/health/sliding_quantiles.h"
#include "rotrocc/OdometryStatus.h"
#include "stress/fault_injector.h"

namespace rotrocc {

/// Whether all numbers of an odometry are finite, its quaternion has unit length and its variances
/// are not negative.
bool isSound(const nav_msgs::Odometry& odometry);

/// What became of the images, as the odometry counts them.
struct ImageAccount {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;                    ///< the rest is lost in the queues of ROS
  std::uint64_t used = 0;                        ///< for a result
  std::map<std::string, std::uint64_t> dropped;  ///< by reason

  /// Whether each image was used or dropped for a reason.
  bool addsUp() const;
};

/// Warnings and errors from the beginning of a fault to that of the next one.
struct FaultLog {
  const Fault* fault;
  ros::Time begin;
  std::vector<std::string> lines;
};

/// Listens to an odometry under stress, which has just been started: counts its answers, the images
/// it used and dropped, and what the log says.
class AnswerAudit {
 public:
  explicit AnswerAudit(ros::NodeHandle& nh);

  bool connected() const { return odom_.getNumPublishers() > 0; }

  /// To be called when `images` of a pair are sent.
  void expect(const ros::Time& stamp, std::uint64_t images);

  /// To be called when stamps restart: the odometry must become OK again.
  void beginLoop();

  /// To be called when a fault begins. What the log says from now on is of it.
  void beginFault(const Fault& fault);

  /// To be called when a fault has ended: the odometry must become OK again.
  void endFault();

  /// Whether it became OK in this loop.
  bool loopRecovered() const;

  /// Whether it became OK with a pair sent since the last fault.
  bool recovered() const;

  ImageAccount images() const;

  /// Whether the odometry's log has a warning or an error that contains `part`.
  bool logged(const std::string& part) const;

  /// What the log said of each fault, in their order.
  std::vector<FaultLog> faultLogs() const;

  /// A table: answers, their age, what became of the images, loops, recoveries and the log.
  std::string report() const;

  /// Whether every answer was valid, all images are accounted for, and the odometry became OK in
  /// every loop but the last, which may have just started.
  bool passed() const;

 private:
  using Clock = std::chrono::steady_clock;

  void onOdometry(const nav_msgs::Odometry::ConstPtr& message);
  void onStatus(const OdometryStatus::ConstPtr& message);
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message);
  void onLog(const rosgraph_msgs::Log::ConstPtr& message);
  ImageAccount account() const;

  mutable std::mutex mutex_;
  std::map<ros::Time, Clock::time_point> sent_;
  std::uint64_t pairs_sent_ = 0, images_sent_ = 0, answers_ = 0, unsound_ = 0;
  SlidingQuantiles ages_ms_{250'000};  // an hour at 60 Hz
  std::uint64_t loops_ = 0, loops_recovered_ = 0;
  bool loop_recovered_ = false;
  std::uint64_t faults_ = 0, faults_recovered_ = 0;
  bool recovered_ = false;
  std::set<ros::Time> sent_since_fault_;
  OdometryStatus last_status_;
  std::map<std::string, std::uint64_t> images_received_;  // by topic
  std::map<std::string, std::uint64_t> log_;  // counts of texts, with # for their numbers
  std::vector<FaultLog> fault_logs_;

  // Last, so that no callback runs after the other members are destroyed.
  ros::Subscriber odom_, status_, diagnostics_, rosout_;
};

}  // namespace rotrocc
