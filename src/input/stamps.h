#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace rotrocc {

/// Timestamps of images [ns], in increasing order.
using Stamps = std::vector<std::int64_t>;

/// Period of the images [ns]: the median step, without those over lost images. Most images may be
/// lost, but less than a quarter of the steps may be much shorter than the period. None without a
/// step forward.
std::optional<std::int64_t> periodOf(const Stamps& stamps_ns);

/// Indices of left and right stamps that differ by at most `tolerance_ns`: each left stamp with the
/// nearest right one, unless that is nearer to the next left one.
std::vector<std::pair<std::size_t, std::size_t>> matchStamps(const Stamps& left_ns,
                                                             const Stamps& right_ns,
                                                             std::int64_t tolerance_ns);

/// Right minus left stamps [s].
struct StampSkew {
  double largest_s = 0.0;  ///< magnitude; of images without a lost partner, if there are any
  std::optional<double> median_s;  ///< of the nearest stamps; none if there are few
  /// A skew of about a period, as of a camera whose stamps are late: the nearest stamps are those
  /// of neighbors. Images of the same time are known by their common jitter; none if there is none.
  std::optional<double> of_a_period_s;
};

/// None while a side has no stamps.
std::optional<StampSkew> skewOf(const Stamps& left_ns,
                                const Stamps& right_ns,
                                std::optional<std::int64_t> period_ns);

}  // namespace rotrocc
