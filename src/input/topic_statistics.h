#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace rotrocc {

/// Statistics of the recent messages on a topic.
class TopicStatistics {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time window of rates and counts.
  static constexpr std::chrono::seconds kWindow{5};

  /// A message that arrives later than this after the one before starts a new run.
  static constexpr std::chrono::seconds kLongestStep{1};

  void add(Time now);

  std::uint64_t total() const { return total_; }
  /// Arrival of the last message, and of the first one of its run; there must be one.
  Time lastArrival() const { return arrivals_.back(); }
  Time startOfRun() const { return start_of_run_; }
  /// Seconds since the last message; none if there was none.
  std::optional<double> silent_s(Time now) const;
  /// Messages within the window.
  std::size_t recent(Time now) const { return since(now - kWindow); }
  /// Messages from a time within the window on.
  std::size_t since(Time begin) const;
  /// Mean rate within the window; 0 for fewer than two messages.
  double rate_hz(Time now) const;

 private:
  std::uint64_t total_ = 0;
  std::deque<Time> arrivals_;
  Time start_of_run_;
};

}  // namespace rotrocc
