#pragma once

#include <chrono>
#include <optional>

namespace rotrocc {

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
