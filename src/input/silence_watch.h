#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "input/input_report.h"
#include "input/log.h"

namespace rotrocc {

/// Logs missing pairs, and their return; gaps too short for that at their end, and stamps that jump
/// forward. Uses real time: simulated time may stand still. Not thread-safe.
class SilenceWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A pair that has arrived.
  struct Pair {
    std::int64_t stamp_ns;
    double stamp_age_s;  ///< 0 if ROS time is not known
  };

  /// Warns after `silence_s` without a pair, counted from `now` at first.
  SilenceWatch(double silence_s, Time now, Log log);

  /// Call for every pair, with the number of images that were `dropped` so far. Logs the end of a
  /// silence that was logged. Warns, at most every 5 s, of one that was far longer than usual,
  /// unless half of its pairs were dropped, which the log has said, or much shorter than the stamps
  /// say, unless that is by clocks that differ: then their age tells it.
  void onPair(const Pair& pair, std::uint64_t dropped, Time now);

  /// Call about once a second. Warns of a silence with its duration, the received messages and a
  /// remedy: at its start, when topics or their messages appear or disappear (at most every 5 s),
  /// and as a reminder after 10, 20, 40 s and then every minute; but not while simulated time
  /// stands still, as nobody expects pairs then.
  void onTick(const InputReport& input, Time now);

 private:
  using Duration = std::chrono::duration<double>;

  Duration silence(Time now) const { return now - last_pair_; }
  bool isGap(Duration silence, std::uint64_t dropped) const;
  bool isJump(const Pair& pair, Duration passed) const;

  Log log_;
  Duration silence_limit_;
  Time last_pair_;
  std::optional<Pair> last_;
  std::uint64_t dropped_ = 0;       // until then
  std::deque<Duration> intervals_;  // the latest, between pairs
  bool told_ = false;               // this silence was reported
  Time last_told_;
  Time last_warning_;      // of a gap or a jump
  std::string situation_;  // at the last report
  std::chrono::seconds reminder_{};
};

}  // namespace rotrocc
