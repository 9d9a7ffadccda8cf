#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc {

/// Pixels of an image, and where between them [px / 2^15] those of a window lie.
struct Patch {
  const std::uint8_t* pixels;
  std::ptrdiff_t step;
  std::int16_t fx, fy;
};

/// A window's grey levels, in units of 1 / 2^kValueBits, and gradients, in rows of `stride`
/// numbers, whole registers; those beyond the side have no gradient.
struct Window {
  static constexpr int kValueBits = 6;
  static constexpr int kGradientBits = 5;

  int side, stride;
  std::int16_t* values;
  std::int16_t* gradient_x;
  std::int16_t* gradient_y;
  const std::int16_t* mask;  ///< of a row: -1 within the side, else 0
  const std::int16_t*
      spread;             ///< to take a value from so far aside, by column and by row [px / 2^15]
  std::int16_t* samples;  ///< scratch memory: values with a margin of one pixel ...
  int sample_stride;      ///< ... in rows that are a register longer than side + 2, rounded up
};

/// Sums over a window of gradients and of their products.
struct GradientSums {
  std::int64_t x, y;
  std::int64_t xx, xy, yy;
};

/// Sums over a window of differences, and of differences times gradients.
struct MismatchSums {
  std::int64_t one;
  std::int64_t x, y;
};

namespace ROTROCC_INSTRUCTIONS {

/// Fills the window; the patch has its margin.
GradientSums takeWindow(const Patch& patch, Window window);

/// Compares the window with the patch, which has no margin.
MismatchSums compareWindow(const Patch& patch, const Window& window);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
