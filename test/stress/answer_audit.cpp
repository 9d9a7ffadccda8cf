#include "stress/answer_audit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iterator>
#include <regex>
#include <sstream>

#include <ros/this_node.h>

namespace rotrocc {
namespace {

constexpr std::uint32_t kQueueSize = 1000;
/// Limit of pairs without an answer that are kept.
constexpr std::size_t kMaxPending = 1000;
/// A row of the report.
template <class Value>
std::string row(const std::string& name, const Value& value) {
  std::ostringstream text;
  text << std::left << std::setw(27) << name << std::fixed << std::setprecision(1) << value << '\n';
  return text.str();
}

std::uint64_t countDropped(const ImageAccount& images) {
  std::uint64_t dropped = 0;
  for (const auto& [reason, count] : images.dropped) dropped += count;
  return dropped;
}

/// How many images one drop for that reason is: 0 for a camera_info, 2 for a pair.
std::uint64_t imagesPerDrop(const std::string& reason) {
  if (reason == "camera_info_invalid") return 0;
  const bool is_one = reason == "no_partner" || reason == "partner_dropped";
  return is_one || reason.compare(0, 6, "stamp_") == 0 ? 1 : 2;
}

std::string imageTable(const ImageAccount& images) {
  const std::uint64_t lost = images.sent - images.received;
  std::string text = row("images sent", images.sent) + row("  lost in queues of ROS", lost) +
                     row("  used", images.used);
  for (const auto& [reason, count] : images.dropped) text += row("  " + reason, count);
  return text + row("  sum", lost + images.used + countDropped(images)) +
         (images.addsUp() ? "the counts add up\n" : "THE COUNTS DO NOT ADD UP\n");
}

}  // namespace

bool ImageAccount::addsUp() const {
  return received <= sent && received == used + countDropped(*this);
}

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
      status_(nh.subscribe("status", kQueueSize, &AnswerAudit::onStatus, this)),
      diagnostics_(nh.subscribe("/diagnostics", kQueueSize, &AnswerAudit::onDiagnostics, this)),
      rosout_(nh.subscribe("/rosout", kQueueSize, &AnswerAudit::onLog, this)) {}

void AnswerAudit::expect(const ros::Time& stamp, std::uint64_t images) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++pairs_sent_;
  images_sent_ += images;
  sent_[stamp] = Clock::now();
  if (sent_.size() > kMaxPending) sent_.erase(sent_.begin());
  if (!recovered_) sent_since_fault_.insert(stamp);
}

void AnswerAudit::beginLoop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (loops_ > 0 && loop_recovered_) ++loops_recovered_;
  ++loops_;
  loop_recovered_ = false;
  sent_.clear();
  sent_since_fault_.clear();
}

void AnswerAudit::beginFault(const Fault& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fault_logs_.push_back({&fault, ros::Time::now(), {}});
}

void AnswerAudit::endFault() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++faults_;
  recovered_ = false;
  sent_since_fault_.clear();
}

bool AnswerAudit::loopRecovered() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return loop_recovered_;
}

bool AnswerAudit::recovered() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recovered_;
}

ImageAccount AnswerAudit::images() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return account();
}

ImageAccount AnswerAudit::account() const {
  ImageAccount images;
  images.sent = images_sent_;
  for (const auto& [topic, count] : images_received_) images.received += count;
  images.used = 2 * last_status_.pairs_processed;
  for (const DropCount& drop : last_status_.drops) {
    const std::uint64_t dropped = drop.count * imagesPerDrop(drop.reason);
    if (dropped > 0) images.dropped[drop.reason] = dropped;
  }
  return images;
}

bool AnswerAudit::logged(const std::string& part) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::any_of(log_.begin(), log_.end(), [&](const auto& entry) {
    return entry.first.find(part) != std::string::npos;
  });
}

std::vector<FaultLog> AnswerAudit::faultLogs() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_logs_;
}

void AnswerAudit::onOdometry(const nav_msgs::Odometry::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++answers_;
  if (!isSound(*message)) ++unsound_;
  const auto sent = sent_.find(message->header.stamp);
  if (sent == sent_.end()) return;
  const std::chrono::duration<double, std::milli> age = Clock::now() - sent->second;
  ages_ms_.add(age.count());
  sent_.erase(sent);
}

void AnswerAudit::onStatus(const OdometryStatus::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_status_ = *message;
  if (message->state != OdometryStatus::OK) return;
  loop_recovered_ = true;
  if (recovered_ || sent_since_fault_.count(message->header.stamp) == 0) return;
  recovered_ = true;
  if (faults_ > 0) ++faults_recovered_;
}

/// The part "input" has, for each topic: "10.0 Hz, 50 in 5 s, 123 in total, 1 publishers".
void AnswerAudit::onDiagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& part : message->status) {
    for (const auto& entry : part.values) {
      unsigned long long total = 0;
      if (entry.key.find("image_rect") == std::string::npos ||
          std::sscanf(entry.value.c_str(), "%*f Hz, %*u in 5 s, %llu in total", &total) != 1) {
        continue;
      }
      images_received_[entry.key] = total;
    }
  }
}

void AnswerAudit::onLog(const rosgraph_msgs::Log::ConstPtr& message) {
  if (message->level < rosgraph_msgs::Log::WARN || message->name == ros::this_node::getName()) {
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  ++log_[std::regex_replace(message->msg, std::regex("[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?"), "#")];
  const auto after = std::find_if(fault_logs_.begin(), fault_logs_.end(), [&](const auto& log) {
    return log.begin > message->header.stamp;
  });
  if (after != fault_logs_.begin()) std::prev(after)->lines.push_back(message->msg);
}

std::string AnswerAudit::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const double sent = static_cast<double>(std::max<std::uint64_t>(pairs_sent_, 1));
  const double share = 100.0 * (1.0 - static_cast<double>(answers_) / sent);
  std::string text =
      row("pairs sent", pairs_sent_) + row("answers", answers_) +
      row("without an answer [%]", std::max(share, 0.0)) +
      row("answers that are unsound", unsound_) + row("age, median [ms]", ages_ms_.quantile(0.5)) +
      row("age, p95 [ms]", ages_ms_.quantile(0.95)) +
      row("age, largest [ms]", ages_ms_.quantile(1.0)) +
      row("estimator, last pair [ms]", last_status_.time_total) + imageTable(account());
  if (loops_ > 1) text += row("loops", loops_ - 1) + row("loops recovered", loops_recovered_);
  if (faults_ > 0) text += row("faults", faults_) + row("faults recovered", faults_recovered_);
  for (const auto& [said, count] : log_) {
    text += "log: " + std::to_string(count) + " x " + said + '\n';
  }
  return text;
}

bool AnswerAudit::passed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return answers_ > 0 && unsound_ == 0 && account().addsUp() &&
         (loops_ < 2 || loops_recovered_ == loops_ - 1);
}

}  // namespace rotrocc
