#include "player/odometry_monitor.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace rotrocc {

OdometryMonitor::OdometryMonitor(ros::NodeHandle& nh)
    : odom_(nh.subscribe("odom", 100, &OdometryMonitor::onOdometry, this)),
      status_(nh.subscribe("status", 100, &OdometryMonitor::onStatus, this)) {}

void OdometryMonitor::expect(const ros::Time& stamp) {
  std::lock_guard<std::mutex> lock(mutex_);
  pending_[stamp] = WallClock::now();
  ++pairs_expected_;
}

bool OdometryMonitor::wait(const ros::Time& stamp, std::chrono::duration<double> timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  return received_.wait_for(lock, timeout, [&] { return pending_.count(stamp) == 0; });
}

void OdometryMonitor::restart() {
  std::lock_guard<std::mutex> lock(mutex_);
  pending_.clear();
}

std::string OdometryMonitor::summary() const {
  std::lock_guard<std::mutex> lock(mutex_);
  std::ostringstream text;
  text << pairs_expected_ << " pairs played, " << pairs_answered_ << " answered, " << pairs_lost_
       << " lost, " << pairs_expected_ - pairs_answered_ << " dropped, " << std::fixed
       << std::setprecision(1) << latency_sum_.count() / std::max(pairs_answered_, 1)
       << " ms from pair to result";
  return text.str();
}

void OdometryMonitor::onAnswer(const ros::Time& stamp) {
  std::lock_guard<std::mutex> lock(mutex_);
  const auto sent = pending_.find(stamp);
  if (sent == pending_.end()) return;
  latency_sum_ += WallClock::now() - sent->second;
  ++pairs_answered_;
  pending_.erase(pending_.begin(), std::next(sent));  // earlier ones will not arrive any more
  received_.notify_all();
}

void OdometryMonitor::onStatus(const OdometryStatus::ConstPtr& message) {
  if (message->state != OdometryStatus::LOST) return;
  onAnswer(message->header.stamp);
  std::lock_guard<std::mutex> lock(mutex_);
  ++pairs_lost_;
}

}  // namespace rotrocc
