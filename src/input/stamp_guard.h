#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace rotrocc {

/// Distinguishes valid stamps of a topic from those of a faulty driver and from time jumps, e.g. of
/// a looping bag.
class StampGuard {
 public:
  /// `topic`: name in messages. Stamps more than `max_future_s` ahead of the clock are rejected.
  StampGuard(const std::string& topic, double max_future_s);

  /// `clock_ns`: ROS time at the arrival; 0 if unknown, as in simulated time before the first
  /// /clock. Throws InputError on a stamp that is zero, repeated, slightly earlier than the
  /// previous one or far ahead of the clock.
  ///
  /// An earlier stamp is accepted as a time jump if it is earlier by a second or more, if the clock
  /// jumped back as well, or if it is the third in a row.
  void check(std::int64_t stamp_ns, std::int64_t clock_ns);

 private:
  void checkClock(std::int64_t stamp_ns, std::int64_t clock_ns) const;
  bool beginsAnew(std::int64_t stamp_ns);

  std::string topic_;
  double max_future_s_;
  std::int64_t last_clock_ns_ = 0;
  bool clock_went_back_ = false;  // since the last usable stamp
  std::optional<std::int64_t> last_stamp_ns_;
  std::optional<std::int64_t> last_backward_ns_;
  int backward_in_a_row_ = 0;
};

}  // namespace rotrocc
