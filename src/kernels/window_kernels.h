#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc {

/// Pixels of an image, and the sub-pixel offset of a window on them [px / 2^15].
struct Patch {
  const std::uint8_t* pixels;
  std::ptrdiff_t step;
  std::int16_t fx, fy;
};

/// The gray levels of a window, in units of 1 / 2^kValueBits, and its gradients. A row has kStride
/// values, of which `side` are used. Gradients beyond are zero.
struct Window {
  static constexpr int kMaxSide = 51;
  static constexpr int kStride = 64;  ///< whole registers
  static constexpr int kValueBits = 6;
  static constexpr int kGradientBits = 5;
  static constexpr int kContrastBits = 3;

  using Rows = std::int16_t[kMaxSide * kStride];

  int side;
  Rows values, gradient_x, gradient_y;
  Rows contrast;               ///< values less the middle one, in units of 1 / 2^kContrastBits
  std::int16_t mask[kStride];  ///< for a row: -1 within the side, else 0
};

/// Sums of the gradients and of the contrast over a window, and of their products.
struct WindowSums {
  std::int64_t x, y, contrast;
  std::int64_t xx, xy, yy;
  std::int64_t contrast_x, contrast_y, contrast_square;
};

/// Sums of differences, in units of 1 / 2^Window::kValueBits, and of their products with the
/// gradients. Those with the contrast and of squares are of differences in units of 1 /
/// 2^kDifferenceBits.
struct MismatchSums {
  static constexpr int kDifferenceBits = 4;

  std::int64_t one;
  std::int64_t x, y;
  std::int64_t contrast;
  std::int64_t square;
};

namespace ROTROCC_INSTRUCTIONS {

/// Fills the window. The patch must include its margin.
WindowSums takeWindow(const Patch& patch, Window& window);

/// Compares the window with the patch, which has no margin.
MismatchSums compareWindow(const Patch& patch, const Window& window);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
