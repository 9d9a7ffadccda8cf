#pragma once

#include <cmath>
#include <string>

#include "input/to_text.h"

namespace rotrocc {

/// A number with at most two decimals.
inline std::string hundredths(double value) {
  return toText(0.01 * std::round(100.0 * value));
}

}  // namespace rotrocc
