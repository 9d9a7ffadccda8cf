#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "input/camera_clock.h"
#include "input/input_report.h"
#include "input/log.h"

namespace rotrocc {

/// Logs missing pairs, and their return; gaps too short for that at their end, and stamps that jump
/// forward. Uses real time: simulated time may stand still. Not thread-safe.
class SilenceWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Warns after `no_input_warning_s` without a pair, counted from `now` at first.
  SilenceWatch(double no_input_warning_s, Time now, Log log);

  /// Call for every pair, with the age of its stamp in ROS time (0 if unknown) and the number of
  /// images that were `dropped` so far. Logs the end of a silence that was logged. Warns, at most
  /// every 5 s, of one far longer than usual (unless half of its pairs were dropped, which is
  /// logged) or much shorter than the stamps say (unless clocks differ, which their age shows).
  void onPair(std::int64_t stamp_ns, double stamp_age_s, std::uint64_t dropped, Time now);

  /// Call about once a second. Sets whether ROS time stands still, as simulated time does while a
  /// replay is paused and after its end. Warns of a silence with its duration, the received
  /// messages and a remedy: at its start, when topics or their messages appear or disappear (at
  /// most every 5 s), and as a reminder at growing intervals, see Throttle; but not while the clock
  /// stands still, as nobody expects pairs then.
  void onTick(InputReport& input, const Arrival& now);

 private:
  using Duration = std::chrono::duration<double>;

  bool isGap(Duration silence, std::uint64_t dropped) const;
  bool isJump(std::int64_t stamp_ns, double stamp_age_s, Duration silence) const;

  Log log_;
  Duration silence_limit_;
  Time last_pair_;
  std::optional<std::int64_t> last_stamp_ns_;
  double last_stamp_age_s_ = 0.0;
  std::uint64_t dropped_ = 0;       // until then
  std::deque<Duration> intervals_;  // the latest, between pairs
  Arrival clock_moved_;             // when ROS time last moved, as far as known
  bool logged_ = false;             // this silence was reported
  Time last_logged_;
  Time last_warning_;      // of a gap or a jump
  std::string situation_;  // at the last report
  Throttle reminder_;
};

}  // namespace rotrocc
