#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "input/input_error.h"
#include "input/stamp_series.h"

namespace rotrocc {

/// Distinguishes valid stamps of a topic from those of a faulty driver and from time jumps, e.g. of
/// a looping bag.
///
/// A stamp that is further ahead of the clock than those before it, or far behind them, is a glitch
/// or the first one after a jump. The next image tells: until then this one is held.
class StampGuard {
 public:
  /// What to do with an image, and with the one before it if that was held.
  struct Verdict {
    bool held = false;                 ///< keep the image until the next call
    bool held_is_valid = false;        ///< the one before it comes after a time jump: use it first
    std::optional<InputError> glitch;  ///< the one before it is to be dropped
  };

  /// `topic`: name in messages. Stamps more than `max_future_s` ahead of the clock are rejected.
  StampGuard(const std::string& topic, double max_future_s);

  /// `clock_ns`: ROS time at the arrival; 0 if unknown, as in simulated time before the first
  /// /clock. Throws InputError on a stamp that is zero, repeated, slightly earlier than the
  /// previous one or far ahead of the clock; an image that is held stays so.
  ///
  /// An earlier stamp is accepted at once as a time jump if the clock jumped back as well, or if it
  /// is that of the first images or an earlier one, as in a loop. One less than a second earlier
  /// is accepted if it is the third in a row.
  Verdict check(std::int64_t stamp_ns, std::int64_t clock_ns);

  /// How far the clock is ahead of the stamps of recent images in time when they arrive; none if
  /// there are none, or ROS time is not known.
  std::optional<double> age_s() const;

 private:
  struct Arrival {
    std::int64_t stamp_ns;
    std::int64_t clock_ns;

    std::int64_t ahead_ns() const { return stamp_ns - clock_ns; }
  };

  void checkClock(const Arrival& arrival) const;
  bool continues(const Arrival& arrival);
  bool goesBack(const Arrival& arrival);
  std::int64_t usualAhead_ns() const;
  std::int64_t tolerance_ns() const;
  InputError glitchOf(const Arrival& held) const;
  void accept(const Arrival& arrival);
  void restart();

  std::string topic_;
  double max_future_s_;
  std::int64_t last_clock_ns_ = 0;
  bool clock_went_back_ = false;  // since the last usable stamp
  std::optional<std::int64_t> last_stamp_ns_;
  std::optional<std::int64_t> first_stamp_ns_;  // since the last jump back
  std::optional<std::int64_t> last_backward_ns_;
  int backward_in_a_row_ = 0;
  std::optional<Arrival> held_;
  StampSeries series_;
  std::deque<std::int64_t> ahead_ns_;  // of the clock, the latest stamps
};

}  // namespace rotrocc
