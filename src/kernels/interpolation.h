#pragma once

#include <cstdint>

#include "kernels/lanes.h"
#include "kernels/window_kernels.h"

/// Values between pixels, in units of 1 / 2^kBits grey levels.
namespace rotrocc::ROTROCC_INSTRUCTIONS {

/// Between each pixel and its right neighbour at fx / 2^15.
template <int kBits>
Shorts betweenColumns(const std::uint8_t* pixels, const Shorts& fx) {
  const Shorts left = loadBytes(pixels);
  const Shorts right = loadBytes(pixels + 1);
  return shiftLeft<kBits>(left) + v_mul_hi(shiftLeft<kBits + 1>(right - left), fx);
}

inline Shorts betweenRows(const Shorts& upper, const Shorts& lower, const Shorts& fy) {
  return upper + v_mul_hi(shiftLeft<1>(lower - upper), fy);
}

/// Samples a patch. Rows of `out` are written in whole registers.
template <int kBits>
void samplePatch(const Patch& patch, int columns, int rows, std::int16_t* out, int stride) {
  const Shorts fx = vx_setall_s16(patch.fx);
  const Shorts fy = vx_setall_s16(patch.fy);
  for (int x = 0; x < columns; x += kShorts) {
    const std::uint8_t* pixels = patch.pixels + x;
    Shorts upper = betweenColumns<kBits>(pixels, fx);
    for (int y = 0; y < rows; ++y) {
      pixels += patch.step;
      const Shorts lower = betweenColumns<kBits>(pixels, fx);
      v_store(out + y * stride + x, betweenRows(upper, lower, fy));
      upper = lower;
    }
  }
}

}  // namespace rotrocc::ROTROCC_INSTRUCTIONS
