#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/instructions.h"

namespace rotrocc {

/// A window of the left image that is looked for in a row of the right one, at whole pixels.
struct SadSearch {
  /// Pixels of a side of the windows.
  static constexpr int kWindow = 11;
  /// Pixels that are read of each row of a window.
  static constexpr int kReadPixels = 16;
  /// Costs are made in groups of so many.
  static constexpr int kGroup = 16;
  /// Stands for the cost of a window that is higher than any of interest.
  static constexpr std::int16_t kHigh = 32767;

  const std::uint8_t* left;  ///< upper left corner of the window
  std::ptrdiff_t left_step;
  const std::uint8_t* right;  ///< that of the first window; the others begin a pixel farther each
  std::ptrdiff_t right_step;
  int count;          ///< of windows of the right image
  double most;        ///< a match costs no more ...
  double uniqueness;  ///< ... and no more than this times what another window costs
};

namespace ROTROCC_INSTRUCTIONS {

/// Rows of a window that are compared first, without the pixels at its edge: eight of each.
constexpr int kPartRows[] = {1, 3, 7, 9};
constexpr int kPartEdge = 1;

/// What part of a window may cost for the whole to be compared, if `least` is the cheapest: half as
/// much again, and two grey levels a pixel. For 4 corners in 1000 of KITTI that changes the answer.
constexpr int partLimit(int least) {
  return least + least / 2 + 64;
}

/// Fills `costs` (in whole groups) with sums of absolute differences; kHigh where part of a window
/// costs too much, and maybe where the whole costs too much to be a match or a rival of one. Of the
/// right image up to a group of pixels beyond those of the last window are read.
void sadCosts(const SadSearch& search, std::int16_t* costs);

/// The cost of the k-th window, whatever it is.
int sadCost(const SadSearch& search, int k);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
