#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <nav_msgs/Odometry.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/time.h>

#include "rotrocc/OdometryStatus.h"

namespace rotrocc {

/// Whether all numbers of an odometry are finite, its quaternion has unit length and its variances
/// are not negative.
bool isSound(const nav_msgs::Odometry& odometry);

/// Listens to `odom` and `status` of an odometry under stress, and counts its answers.
class AnswerAudit {
 public:
  explicit AnswerAudit(ros::NodeHandle& nh);

  bool connected() const { return odom_.getNumPublishers() > 0; }

  /// To be called when a pair is sent.
  void expect(const ros::Time& stamp);

  /// To be called when stamps restart: the odometry must become OK again.
  void beginLoop();

  /// A table: answers, their age, what was dropped, loops.
  std::string report() const;

  /// Whether every answer was valid and the odometry became OK in every loop but the last, which
  /// may have just started.
  bool passed() const;

 private:
  using Clock = std::chrono::steady_clock;

  void onOdometry(const nav_msgs::Odometry::ConstPtr& message);
  void onStatus(const OdometryStatus::ConstPtr& message);

  mutable std::mutex mutex_;
  std::map<ros::Time, Clock::time_point> sent_;
  std::uint64_t pairs_sent_ = 0, answers_ = 0, unsound_ = 0;
  std::vector<float> ages_ms_;
  std::uint64_t loops_ = 0, loops_recovered_ = 0;
  bool recovered_ = false;
  OdometryStatus last_status_;

  // Last, so that no callback runs after the other members are destroyed.
  ros::Subscriber odom_, status_;
};

}  // namespace rotrocc
