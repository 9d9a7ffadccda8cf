#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace rotrocc {

/// What came on one of the four topics in the last seconds.
struct TopicReport {
  std::string topic;
  std::size_t publishers = 0;
  std::size_t recent = 0;  ///< messages within TopicStatistics::kWindow
  std::uint64_t total = 0;
  double rate_hz = 0.0;
};

/// What came in, and what keeps it from becoming pairs.
struct InputReport {
  TopicReport left_image, right_image, left_info, right_info;
  std::size_t recent_pairs = 0;
  std::optional<double> stamp_difference_s;  ///< the greatest; none while a side is missing
  double max_stamp_difference_s = 0.0;       ///< the parameter
  bool clock_missing = false;                ///< simulated time without /clock
  std::string refused;          ///< why the last input was refused lately; empty if none was
  std::string camera_error;     ///< why there is no camera although both infos came
  bool waits_for_info = false;  ///< a pair is there and waits for camera_info
};

/// The greatest difference of a left stamp to the nearest right one [s]; none if a side has none.
std::optional<double> greatestStampDifference(const std::deque<std::int64_t>& left_ns,
                                              const std::deque<std::int64_t>& right_ns);

/// "left/image_rect 50 (10.0 Hz), right/image_rect 0, ..."
std::string describeTopics(const InputReport& report);

/// What most likely is the reason that there are no pairs, and what to change; one sentence. Empty
/// if nothing is wrong with the input.
std::string whyNoPairs(const InputReport& report);

}  // namespace rotrocc
