#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc {

/// Products of the x and y gradients, summed over kSide rows, for each column.
struct ColumnSums {
  static constexpr int kSide = 5;  ///< [px]

  std::int32_t* xx;
  std::int32_t* xy;
  std::int32_t* yy;
};

namespace ROTROCC_INSTRUCTIONS {

// For the smaller images of a pyramid.

/// Smooths every other pixel along the row by (1 4 6 4 1). Reads two pixels before the first one
/// and three after the last one. There must be kMaxShorts columns or more.
void smoothAlong(const std::uint8_t* pixels, int columns, std::int16_t* sums);

/// Smooths five results of smoothAlong() vertically, by (1 4 6 4 1) / 256 in total, and rounds.
void smoothDown(const std::int16_t* const* rows, int columns, std::uint8_t* out);

// For the corner response and its peaks.

/// Smooths a row vertically by (1 2 1), and differentiates it vertically, using the rows above and
/// below.
void differentiateRow(const std::uint8_t* above,
                      const std::uint8_t* here,
                      const std::uint8_t* below,
                      int columns,
                      std::int16_t* smooth,
                      std::int16_t* steps);

/// Computes Sobel gradients from the results of differentiateRow(), which must both start one
/// column earlier. They replace those in `gradient_x` and `gradient_y`, and in the sums.
void replaceGradients(const std::int16_t* smooth,
                      const std::int16_t* steps,
                      int columns,
                      std::int16_t* gradient_x,
                      std::int16_t* gradient_y,
                      ColumnSums sums);

/// Smaller eigenvalues of the sums over kSide columns each, divided by the number of pixels, in
/// (gray levels / px)^2.
void respondRow(ColumnSums sums, int columns, float* response);

/// The maximum of each column over some rows, which are `step` values apart.
void highestOfColumns(
    const float* first, std::ptrdiff_t step, int rows, int columns, float* highest);

/// Finds the columns of [first, end) for which the value in `highest` at column + radius is at
/// least `least`, and no value within `radius` of it is larger. Writes them into `peaks` in
/// increasing order. Returns their number.
int findPeaks(const float* highest, int first, int end, int radius, float least, int* peaks);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
