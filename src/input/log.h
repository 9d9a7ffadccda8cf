#pragma once

#include <chrono>
#include <optional>
#include <string>

#include <ros/console.h>

namespace rotrocc {

/// The log of one odometry. Several may run in a process, so each line begins with the name of its
/// node or nodelet, if it has one.
class Log {
 public:
  explicit Log(const std::string& name = "") : prefix_(name.empty() ? "" : name + ": ") {}

  void info(const std::string& text) const { ROS_INFO_STREAM(prefix_ << text); }
  void warn(const std::string& text) const { ROS_WARN_STREAM(prefix_ << text); }
  void error(const std::string& text) const { ROS_ERROR_STREAM(prefix_ << text); }
  void fatal(const std::string& text) const { ROS_FATAL_STREAM(prefix_ << text); }

 private:
  std::string prefix_;
};

/// Limits the rate of log messages in real time: throttled logging of ROS uses simulated time,
/// which may stand still or jump.
class Throttle {
 public:
  explicit Throttle(std::chrono::milliseconds period) : period_(period) {}

  /// Whether the period has passed since the last time this returned true.
  bool pass() {
    const auto now = std::chrono::steady_clock::now();
    if (last_ && now - *last_ < period_) return false;
    last_ = now;
    return true;
  }

 private:
  std::chrono::milliseconds period_;
  std::optional<std::chrono::steady_clock::time_point> last_;
};

}  // namespace rotrocc
