#pragma once

#include <chrono>
#include <cstdint>

namespace rotrocc {

/// Whether ROS time stands still, as simulated time does while a replay is paused and after its
/// end.
class ClockWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Call about once a second, with ROS time; zero, without /clock, is no standstill.
  bool standsStill(std::int64_t clock_ns, Time now) {
    if (clock_ns != clock_ns_) {
      clock_ns_ = clock_ns;
      moved_ = now;
    }
    return clock_ns != 0 && now - moved_ >= kStandstill;
  }

 private:
  /// A slow odometry in lockstep holds the clock for less.
  static constexpr std::chrono::milliseconds kStandstill{1500};

  std::int64_t clock_ns_ = 0;
  Time moved_;
};

}  // namespace rotrocc
