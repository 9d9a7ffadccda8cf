#pragma once

#include <cmath>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>

#include "common/to_seconds.h"

namespace rotrocc {

/// A number as a stream prints it: 0.54, not 0.540000.
template <class Number>
std::string toText(Number value, int digits = 6) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

/// A number with at most two decimals.
inline std::string hundredths(double value) {
  return toText(0.01 * std::round(100.0 * value) + 0.0);  // not -0
}

/// A number with all its digits, so that it can be read back.
inline std::string exactText(double value) {
  return toText(value, std::numeric_limits<double>::max_digits10);
}

/// A number with so many digits behind the point.
inline std::string fixedText(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

/// A stamp in seconds, to the millisecond: 1600000000.123
inline std::string stampText(std::int64_t stamp_ns) {
  return fixedText(toSeconds(stamp_ns), 3);
}

/// "640x480 px"
inline std::string sizeText(std::int64_t width, std::int64_t height) {
  return toText(width) + "x" + toText(height) + " px";
}

}  // namespace rotrocc
