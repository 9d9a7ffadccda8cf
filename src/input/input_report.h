#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "input/stamps.h"

namespace rotrocc {

/// Statistics of the recent messages on a topic.
class TopicStatistics {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time window of rates and counts.
  static constexpr std::chrono::seconds kWindow{5};

  /// A message that arrives later than this after the previous one starts a new run.
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
  /// Arrival of the first message of the present run; there must be one.
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

/// Recent messages on one of the four topics.
struct TopicReport {
  std::string topic;
  std::size_t publishers = 0;
  std::size_t recent = 0;  ///< messages within TopicStatistics::kWindow
  std::uint64_t total = 0;
  double rate_hz = 0.0;
  std::optional<double> silent_s = {};  ///< since the last message; none if there was none
};

/// Recent input, and what prevents pairs.
struct InputReport {
  TopicReport left_image, right_image, left_info, right_info;
  std::size_t recent_pairs = 0;
  std::optional<double> pairs_silent_s;  ///< since the last pair; none if there was none

  /// Within TopicStatistics::kWindow, since both images arrive: images without a partner, but for
  /// those whose partner was dropped, and pairs.
  struct {
    std::size_t left = 0, right = 0, pairs = 0;
  } unmatched;

  std::optional<StampSkew> skew;        ///< none while a side is missing
  double max_stamp_difference_s = 0.0;  ///< the parameter
  double tolerance_s = 0.0;             ///< that in force: at most half a period
  std::optional<double> period_s;       ///< of the images
  std::optional<double> stamp_age_s;    ///< of left images, see CameraClock::age_s()
  double stamp_scatter_s = 0.0;         ///< of left images, see CameraClock
  double arrival_scatter_s = 0.0;       ///< of left images, see CameraClock
  bool clock_missing = false;           ///< simulated time without /clock
  bool clock_stands = false;            ///< simulated time stands still
  std::string rejected;                 ///< why recent input was dropped; empty if none
  std::string camera_error;             ///< why camera_info is invalid or not of the images
  bool has_raw_infos = false;           ///< camera_info of raw images, which are not rectified
  bool waits_for_info = false;          ///< a pair waits for camera_info

  std::array<const TopicReport*, 4> topics() const {
    return {&left_image, &right_image, &left_info, &right_info};
  }
};

/// "left/image_rect 50 (10.0 Hz), right/image_rect 0, ..."
std::string describeTopics(const InputReport& report);

/// The most likely reason for missing pairs, and a remedy, in one sentence; none if the input is
/// fine.
std::optional<std::string> whyNoPairs(const InputReport& report);

/// Which image topic has gone silent, in one sentence; none if both send.
std::optional<std::string> whySilent(const InputReport& report);

/// What is wrong with pairs that arrive: lost images, a skew that makes pairs of different times,
/// or stamps that are old or ahead of the clock. One sentence with a remedy; none if nothing is.
std::optional<std::string> faultOfPairs(const InputReport& report);

/// Whether stamps and clock have nothing to do with each other, as in a replay without /clock.
bool isOfAnotherClock(const InputReport& report);

}  // namespace rotrocc
