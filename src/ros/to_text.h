#pragma once

#include <cstdint>
#include <sstream>
#include <string>

namespace rotrocc {

/// A number as a stream prints it: 0.54, not 0.540000.
template <class Number>
std::string toText(Number value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// "640x480 px"
inline std::string sizeText(std::int64_t width, std::int64_t height) {
  return toText(width) + "x" + toText(height) + " px";
}

}  // namespace rotrocc
