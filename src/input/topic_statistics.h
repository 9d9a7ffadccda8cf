#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
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

  void add(Time now) {
    if (total_ == 0 || now - arrivals_.back() > kLongestStep) start_of_run_ = now;
    ++total_;
    arrivals_.push_back(now);
    while (arrivals_.size() > kMaxArrivals || arrivals_.front() < now - kWindow) {
      arrivals_.pop_front();
    }
  }

  std::uint64_t total() const { return total_; }
  /// Arrival of the last message, and of the first one of its run; there must be one.
  Time lastArrival() const { return arrivals_.back(); }
  Time startOfRun() const { return start_of_run_; }
  /// Seconds since the last message; none if there was none.
  std::optional<double> silent_s(Time now) const {
    if (total_ == 0) return std::nullopt;
    return std::chrono::duration<double>(now - arrivals_.back()).count();
  }
  /// Messages within the window.
  std::size_t recent(Time now) const { return since(now - kWindow); }
  /// Messages from a time within the window on.
  std::size_t since(Time begin) const {
    const auto first = std::lower_bound(arrivals_.begin(), arrivals_.end(), begin);
    return static_cast<std::size_t>(arrivals_.end() - first);
  }
  /// Mean rate within the window; 0 for fewer than two messages.
  double rate_hz(Time now) const {
    const std::size_t count = recent(now);
    if (count < 2) return 0.0;
    const std::chrono::duration<double> length = arrivals_.back() - *(arrivals_.end() - count);
    return length.count() > 0.0 ? static_cast<double>(count - 1) / length.count() : 0.0;
  }

 private:
  static constexpr std::size_t kMaxArrivals = 2000;  // bounds the memory

  std::uint64_t total_ = 0;
  std::deque<Time> arrivals_;
  Time start_of_run_;
};

}  // namespace rotrocc
