#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "input/input_report.h"

namespace rotrocc {

/// Reports missing pairs, and their return, for the log; gaps too short for that at their end, and
/// stamps that jump forward. Uses real time: simulated time may stand still. Not thread-safe.
class SilenceWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Reports after `silence_s` without a pair, counted from `now` at first.
  SilenceWatch(double silence_s, Time now);

  /// Call for every pair. Returns a message if the silence before it was reported, or if it was far
  /// longer than usual, or much shorter than the stamps say, at most every 5 s; otherwise empty.
  std::string onPair(std::int64_t stamp_ns, Time now);

  /// Call about once a second. Returns the duration of the silence, the received messages and a
  /// remedy: at its start, when topics or their messages appear or disappear (at most every 5 s),
  /// and as a reminder after 10, 20, 40 s and then every minute. Otherwise empty; also while
  /// simulated time stands still, as nobody expects pairs then.
  std::string onTick(const InputReport& input, Time now);

 private:
  using Duration = std::chrono::duration<double>;

  bool isGap(Duration silence) const;

  Duration silence_limit_;
  Time last_pair_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::deque<Duration> intervals_;  // the latest, between pairs
  bool told_ = false;               // this silence was reported
  Time last_told_;
  Time last_return_;       // or jump, that was reported
  std::string situation_;  // at the last report
  std::chrono::seconds reminder_{};
};

}  // namespace rotrocc
