#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace rotrocc {

/// Statistics of the recent messages on a topic.
class TopicStatistics {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time window of rates and counts.
  static constexpr std::chrono::seconds kWindow{5};

  void add(std::int64_t stamp_ns, Time now);

  std::uint64_t total() const { return total_; }
  /// Arrival of the last message; there must be one.
  Time lastArrival() const { return arrivals_.back(); }
  /// Messages within the window.
  std::size_t recent(Time now) const;
  /// Mean rate within the window; 0 for fewer than two messages.
  double rate_hz(Time now) const;
  /// Stamps of the latest messages, at most 16.
  const std::deque<std::int64_t>& lastStamps_ns() const { return stamps_ns_; }

 private:
  std::uint64_t total_ = 0;
  std::deque<Time> arrivals_;
  std::deque<std::int64_t> stamps_ns_;
};

}  // namespace rotrocc
