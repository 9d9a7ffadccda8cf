#pragma once

#include <chrono>
#include <string>

#include "input/input_report.h"

namespace rotrocc {

/// Has a word for the log when no pairs come, and when they come again. Goes by real time:
/// simulated time may stand still. Not for several threads at once.
class SilenceWatch {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Without a pair for `silence_s` it is silent; the first such time begins at `now`.
  SilenceWatch(double silence_s, Time now);

  /// To be called of every pair. That pairs come again, if a silence was told of; else empty.
  std::string onPair(Time now);

  /// To be called every second or so. How long it is silent, what came and what to change: once
  /// when it begins, then as soon as topics come, go, begin or cease to deliver, at most every 5 s;
  /// and as a reminder after 10, 20, 40 s and then every minute. Else empty.
  std::string onTick(const InputReport& input, Time now);

 private:
  std::chrono::duration<double> silence_limit_;
  Time last_pair_;
  bool told_ = false;  // of this silence
  Time last_told_;
  std::string situation_;  // when last told
  std::chrono::seconds reminder_{};
};

}  // namespace rotrocc
