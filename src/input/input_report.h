#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace rotrocc {

/// Recent messages on one of the four topics.
struct TopicReport {
  std::string topic;
  std::size_t publishers = 0;
  std::size_t recent = 0;  ///< messages within TopicStatistics::kWindow
  std::uint64_t total = 0;
  double rate_hz = 0.0;
};

/// Recent input, and what prevents pairs.
struct InputReport {
  TopicReport left_image, right_image, left_info, right_info;
  std::size_t recent_pairs = 0;
  std::optional<double> stamp_difference_s;  ///< largest; none while a side is missing
  double max_stamp_difference_s = 0.0;       ///< the parameter
  bool clock_missing = false;                ///< simulated time without /clock
  std::string refused;                       ///< why recent input was dropped; empty if none
  std::string camera_error;                  ///< why camera_info is invalid although both arrived
  bool waits_for_info = false;               ///< a pair waits for camera_info
};

/// Largest difference between a left stamp and the nearest right one [s]; none if a side has none.
std::optional<double> greatestStampDifference(const std::deque<std::int64_t>& left_ns,
                                              const std::deque<std::int64_t>& right_ns);

/// "left/image_rect 50 (10.0 Hz), right/image_rect 0, ..."
std::string describeTopics(const InputReport& report);

/// The most likely reason for missing pairs, and a remedy, in one sentence. Empty if the input is
/// fine.
std::string whyNoPairs(const InputReport& report);

}  // namespace rotrocc
