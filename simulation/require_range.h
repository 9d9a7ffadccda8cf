#pragma once

#include <stdexcept>
#include <string>

namespace rotrocc {

/// Throws std::invalid_argument with the name and the range of a value that is not from `low` to
/// `high`.
inline void requireRange(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(name + " is " + std::to_string(value) + ": choose it from " +
                              std::to_string(low) + " to " + std::to_string(high));
}

}  // namespace rotrocc
