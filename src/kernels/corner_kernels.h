#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc {

/// Products of gradients x and y, summed over rows, for each column.
struct ColumnSums {
  std::int32_t* xx;
  std::int32_t* xy;
  std::int32_t* yy;
};

namespace ROTROCC_INSTRUCTIONS {

/// Smooths a row by (1 2 1) downwards and differentiates it, from the rows above and below.
void differentiateRow(const std::uint8_t* above,
                      const std::uint8_t* here,
                      const std::uint8_t* below,
                      int columns,
                      std::int16_t* smooth,
                      std::int16_t* steps);

/// Makes Sobel's gradients of what differentiateRow() made, of which both begin a column before.
/// They take the place of those in `gradient_x` and `gradient_y`, in the sums as well. Like
/// respondRow() it reads and writes up to a register more than `columns`.
void replaceGradients(const std::int16_t* smooth,
                      const std::int16_t* steps,
                      int columns,
                      std::int16_t* gradient_x,
                      std::int16_t* gradient_y,
                      ColumnSums sums);

/// Smaller eigenvalues of the sums over `side` columns each, over their pixels, in
/// (grey levels / px)^2.
void respondRow(ColumnSums sums, int side, int columns, float* response);

/// The highest number of each column of some rows, which are `step` numbers apart.
void highestOfColumns(
    const float* first, std::ptrdiff_t step, int rows, int columns, float* highest);

/// Writes into `peaks`, in their order, the columns at whose right in `highest`, by `radius`, is a
/// number of at least `least` to which none nearer than radius + 1 is superior. Returns how many.
int findPeaks(const float* highest, int first, int end, int radius, float least, int* peaks);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
