#pragma once

#include <cstdint>

#include "kernels/lanes.h"

/// Values between pixels, in units of 1 / 2^kBits grey levels.
namespace rotrocc::ROTROCC_INSTRUCTIONS {

/// Between each pixel and its right neighbour at fx / 2^15.
template <int kBits>
Shorts betweenColumns(const std::uint8_t* pixels, const Shorts& fx) {
  const Shorts left = loadBytes(pixels);
  const Shorts right = loadBytes(pixels + 1);
  return shiftLeft<kBits>(left) + multiplyHigh(shiftLeft<kBits + 1>(right - left), fx);
}

inline Shorts betweenRows(const Shorts& upper, const Shorts& lower, const Shorts& fy) {
  return upper + multiplyHigh(shiftLeft<1>(lower - upper), fy);
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
