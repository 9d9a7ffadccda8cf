#pragma once

#include <algorithm>
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

}  // namespace rotrocc
