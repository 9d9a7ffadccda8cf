#include "stress/answer_audit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace rotrocc {
namespace {

constexpr std::uint32_t kQueueSize = 100;
/// Limit of pairs without an answer that are kept.
constexpr std::size_t kMaxPending = 1000;
/// Limit of ages that are kept: an hour at 60 Hz.
constexpr std::size_t kMaxAges = 250000;

float quantile(std::vector<float> values, double share) {
  if (values.empty()) return 0.0f;
  const auto index =
      static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

}  // namespace

bool isSound(const nav_msgs::Odometry& odometry) {
  const auto& p = odometry.pose.pose.position;
  const auto& q = odometry.pose.pose.orientation;
  const auto& v = odometry.twist.twist.linear;
  const auto& w = odometry.twist.twist.angular;
  for (const double value : {p.x, p.y, p.z, v.x, v.y, v.z, w.x, w.y, w.z}) {
    if (!std::isfinite(value)) return false;
  }
  if (!(std::abs(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w) - 1.0) < 1e-6)) {
    return false;
  }
  for (std::size_t i = 0; i < 36; ++i) {
    const bool on_diagonal = i % 7 == 0;
    for (const double value : {odometry.pose.covariance[i], odometry.twist.covariance[i]}) {
      if (!std::isfinite(value) || (on_diagonal && value < 0.0)) return false;
    }
  }
  return true;
}

AnswerAudit::AnswerAudit(ros::NodeHandle& nh)
    : odom_(nh.subscribe("odom", kQueueSize, &AnswerAudit::onOdometry, this)),
      status_(nh.subscribe("status", kQueueSize, &AnswerAudit::onStatus, this)) {}

void AnswerAudit::expect(const ros::Time& stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++pairs_sent_;
  sent_[stamp] = Clock::now();
  if (sent_.size() > kMaxPending) sent_.erase(sent_.begin());
}

void AnswerAudit::beginLoop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (loops_ > 0 && recovered_) ++loops_recovered_;
  ++loops_;
  recovered_ = false;
  sent_.clear();
}

void AnswerAudit::onOdometry(const nav_msgs::Odometry::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++answers_;
  if (!isSound(*message)) ++unsound_;
  const auto sent = sent_.find(message->header.stamp);
  if (sent == sent_.end()) return;
  const std::chrono::duration<float, std::milli> age = Clock::now() - sent->second;
  if (ages_ms_.size() < kMaxAges) ages_ms_.push_back(age.count());
  sent_.erase(sent);
}

void AnswerAudit::onStatus(const OdometryStatus::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_status_ = *message;
  if (message->state == OdometryStatus::OK) recovered_ = true;
}

std::string AnswerAudit::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const double sent = static_cast<double>(std::max<std::uint64_t>(pairs_sent_, 1));
  const double share = 100.0 * (1.0 - static_cast<double>(answers_) / sent);
  std::ostringstream text;
  text << line("pairs sent                 %llu\n", static_cast<unsigned long long>(pairs_sent_))
       << line("answers                    %llu\n", static_cast<unsigned long long>(answers_))
       << line("without an answer          %.1f %%\n", std::max(share, 0.0))
       << line("answers that are unsound   %llu\n", static_cast<unsigned long long>(unsound_))
       << line("age of the answers         p50 %.1f ms, p95 %.1f ms, max %.1f ms\n",
               quantile(ages_ms_, 0.5),
               quantile(ages_ms_, 0.95),
               quantile(ages_ms_, 1.0))
       << line("time of the estimator      %.1f ms (last pair)\n",
               static_cast<double>(last_status_.time_total));
  if (loops_ > 1) {
    text << line("loops                      %llu\n", static_cast<unsigned long long>(loops_ - 1))
         << line("loops recovered            %llu\n",
                 static_cast<unsigned long long>(loops_recovered_));
  }
  for (const DropCount& drop : last_status_.drops) {
    text << line(
        "dropped: %-17s %llu\n", drop.reason.c_str(), static_cast<unsigned long long>(drop.count));
  }
  return text.str();
}

bool AnswerAudit::passed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return answers_ > 0 && unsound_ == 0 && (loops_ < 2 || loops_recovered_ == loops_ - 1);
}

}  // namespace rotrocc
