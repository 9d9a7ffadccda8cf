#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/instructions.h"
#include "kernels/window_kernels.h"

namespace rotrocc {

/// The square windows that are correlated.
struct CorrelationWindow {
  static constexpr int kSide = 11;  ///< [px]
  static constexpr int kStride = 16;
  /// Unit of sub-pixel samples: 1 / 2^kSampleBits gray levels.
  static constexpr int kSampleBits = 3;
  /// The part of a window that is compared first: eight pixels of four rows.
  static constexpr int kParts = 4;
  static constexpr int kPartRows[kParts] = {1, 4, 6, 9};
  static constexpr int kPartFirst = 1;
  static constexpr int kPartWidth = 8;
  static constexpr int kPartPixels = kParts * kPartWidth;

  /// Memory that correlateParts() needs for `count` windows, in 32-bit values.
  static constexpr int scratchOf(int count) { return 3 * (count + kScratchMargin); }
  static constexpr int kScratchMargin = 48;
};

/// Sums over two windows a and b: of b, of its squares, and of the products.
struct ProductSums {
  std::int32_t b, bb, ab;
};

namespace ROTROCC_INSTRUCTIONS {

// Strips are kSide rows of 16-bit values, of which the k-th window begins in column k. All
// functions read and write rows in whole registers.

/// Copies pixels into a strip of `columns`.
void widenRows(
    const std::uint8_t* pixels, std::ptrdiff_t step, int columns, std::int16_t* strip, int stride);

/// Samples a patch between its pixels, in units of 1 / 2^kSampleBits.
void sampleRows(const Patch& patch, int columns, std::int16_t* strip, int stride);

/// For each of `count` windows of the strip, the square of the correlation coefficient of its part
/// with that of `window`, which has kStride values in a row. Negative if the coefficient is.
/// `noise` is added to the variances. `scratch`: memory for scratchOf(count) values. Returns the
/// largest.
float correlateParts(const std::int16_t* window,
                     const std::int16_t* strip,
                     int stride,
                     int count,
                     float noise,
                     std::int32_t* scratch,
                     float* correlations);

/// For a whole window; `strip` begins with it.
ProductSums multiplyWindow(const std::int16_t* window, const std::int16_t* strip, int stride);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
