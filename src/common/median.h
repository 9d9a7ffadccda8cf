#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace rotrocc {

/// Standard deviation of normal errors, over the median of their absolute values.
constexpr double kDeviationOverMedian = 1.4826;

/// Standard deviation of the median of normal errors, over that of their mean.
constexpr double kMedianOverMean = 1.2533;

/// The median of at least one value; the upper one of an even number. Reorders `values`.
template <class Number>
Number median(std::vector<Number>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The least of at least one value that the share in [0, 1] of them does not exceed. Reorders
/// `values`.
template <class Number>
Number quantile(std::vector<Number>& values, double share) {
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace rotrocc
