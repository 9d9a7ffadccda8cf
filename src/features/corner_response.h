#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kernels/image_kernels.h"

namespace rotrocc {

/// The corner response of the pixels of each second row: the smaller eigenvalue of the second
/// moments of the gradients (Shi and Tomasi, CVPR 1994), averaged over a square, in (grey levels /
/// px)^2. Row r of the response is that of row kRowStep r of the image; between two rows, it hardly
/// changes. Sums are exact, so the response of a pixel does not depend on which rows are requested.
class CornerResponse {
 public:
  static constexpr int kRowStep = 2;
  /// The square has a side of 2 radius + 1 pixels.
  static constexpr int kRadius_px = ColumnSums::kSide / 2;

  /// Fills `response` (CV_32F) with its rows [first_row, last_row) for `image` (CV_8UC1) and
  /// `margin` columns of zeros on both sides. Rows may lie outside the image. The response is zero
  /// there, and where the square would leave the image.
  void compute(const cv::Mat& image, int first_row, int last_row, int margin, cv::Mat& response);

 private:
  void addGradients(const cv::Mat& image, int y);

  static constexpr int kSide = ColumnSums::kSide;

  std::size_t stride_ = 0;  // row length of the buffers below: image width plus padding for SIMD
  std::vector<std::int16_t> smooth_,
      steps_;                               // one row, smoothed and differentiated vertically
  std::vector<std::int16_t> gradients_;     // gradients of the last kSide rows (ring)
  std::vector<std::int32_t> xx_, xy_, yy_;  // products of gradients, summed over those rows
};

}  // namespace rotrocc
