#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/time.h>

#include "rotrocc/OdometryStatus.h"

namespace rotrocc {

/// Monitors the topics `odom` and `status` of an odometry that gets pairs one by one.
class OdometryMonitor {
 public:
  explicit OdometryMonitor(ros::NodeHandle& nh);

  bool connected() const { return odom_.getNumPublishers() > 0; }

  /// Call just before publishing the last image of a pair; `stamp` is that of the left one.
  void expect(const ros::Time& stamp);

  /// Waits for the answer to the pair with this stamp. Returns false on timeout.
  bool wait(const ros::Time& stamp, std::chrono::duration<double> timeout);

  /// Discards pairs without an answer, e.g. when time jumps back.
  void restart();

  /// "51 pairs played, 51 answered, 0 lost, 0 dropped, 9.8 ms from pair to result". The answer is
  /// the odometry, or for a lost pair the status: there may be no odometry then. Dropped pairs have
  /// none.
  std::string summary() const;

 private:
  using WallClock = std::chrono::steady_clock;

  void onAnswer(const ros::Time& stamp);
  void onOdometry(const nav_msgs::Odometry::ConstPtr& message) { onAnswer(message->header.stamp); }
  void onStatus(const OdometryStatus::ConstPtr& message);

  mutable std::mutex mutex_;
  std::condition_variable received_;
  std::map<ros::Time, WallClock::time_point> pending_;
  int pairs_expected_ = 0;
  int pairs_answered_ = 0;
  int pairs_lost_ = 0;
  std::chrono::duration<double, std::milli> latency_sum_{0.0};

  // Last, so that callbacks end before the other members are destroyed.
  ros::Subscriber odom_;
  ros::Subscriber status_;
};

}  // namespace rotrocc
