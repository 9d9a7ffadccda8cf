#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc {

/// A search for a window of the left image in a row of the right one, at integer pixels.
struct SadSearch {
  /// Width and height of the windows in pixels.
  static constexpr int kWindow = 11;
  /// Number of pixels read from each row of a window.
  static constexpr int kReadPixels = 16;
  /// Costs are computed in groups of this size.
  static constexpr int kGroup = 16;
  /// Marks windows whose cost is too high to matter.
  static constexpr std::int16_t kHigh = 32767;

  const std::uint8_t* left;  ///< upper left corner of the window
  std::ptrdiff_t left_step;
  /// Upper left corner of the first window. The others follow at steps of one pixel.
  const std::uint8_t* right;
  std::ptrdiff_t right_step;
  int count;  ///< number of windows in the right image
  /// A match costs at most this, and at most `uniqueness` times the cost of any other window.
  double most;
  double uniqueness;
};

namespace ROTROCC_INSTRUCTIONS {

/// Rows of a window that are compared first, without the pixels at its edge: eight pixels of each.
constexpr int kPartRows[] = {1, 3, 7, 9};
constexpr int kPartEdge = 1;
constexpr int kPartWidth = 8;

/// Limit of the cost of a part for the whole window to be compared, where `least` is the lowest
/// cost of a part: 1.5 times that, plus two grey levels per pixel. On KITTI, the limit changes the
/// result for 0.4 % of the corners.
constexpr int partLimit(int least) {
  return least + least / 2 + 64;
}

/// Fills `costs` (in whole groups) with sums of absolute differences. The value is kHigh if part of
/// a window costs too much, and may be kHigh if the whole window costs too much to be a match or
/// its rival. Reads up to one group of pixels beyond the last window of the right image.
void sadCosts(const SadSearch& search, std::int16_t* costs);

/// The cost of the k-th window, without limits.
int sadCost(const SadSearch& search, int k);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
