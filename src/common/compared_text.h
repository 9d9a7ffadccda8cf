#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <opencv2/core.hpp>

namespace rotrocc {

/// A value that is beyond a limit, in three digits, or as many more as separate it from the limit,
/// or stand before the point.
inline std::string comparedText(double value, double limit) {
  std::string text;
  const int whole_digits = 1 + static_cast<int>(std::log10(std::max(std::abs(value), 1.0)));
  for (int digits = std::max(3, whole_digits); digits < 18; ++digits) {
    text = cv::format("%.*g", digits, value);
    if (text != cv::format("%.*g", digits, limit)) break;
  }
  return text;
}

}  // namespace rotrocc
