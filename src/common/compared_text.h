#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace rotrocc {

/// A value that is beyond a limit, in three digits, or as many more as tell it from the limit.
inline std::string comparedText(double value, double limit) {
  std::string text;
  for (int digits = 3; digits < 18; ++digits) {
    text = cv::format("%.*g", digits, value);
    if (text != cv::format("%.*g", digits, limit)) break;
  }
  return text;
}

}  // namespace rotrocc
