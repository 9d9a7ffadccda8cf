#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

struct Kernels;

/// How much of a corner each pixel of an image is: the smaller eigenvalue of its gradients' second
/// moments (Shi and Tomasi, CVPR 1994), the mean over a square, in (grey levels / px)^2. Sums are
/// exact, so that a pixel's response does not depend on the rows that are asked for.
class CornerResponse {
 public:
  /// The square has a side of 2 radius + 1; the radius is at most 15 px.
  explicit CornerResponse(int block_radius_px);

  /// Fills `response` (CV_32F) with rows [first_row, last_row) of `image` (CV_8UC1) and `margin`
  /// columns of zeros on both sides. Rows may lie outside of the image. The response is zero there
  /// and where the square would leave the image.
  void compute(const cv::Mat& image, int first_row, int last_row, int margin, cv::Mat& response);

 private:
  void addGradients(const cv::Mat& image, int y);

  const Kernels* kernels_;
  int radius_, side_;
  std::size_t stride_ = 0;  // of the rows below: the image's, and room for registers
  std::vector<std::int16_t> smooth_,
      steps_;                            // a row of pixels, smoothed and differentiated downwards
  std::vector<std::int16_t> gradients_;  // x and y of the last `side_` rows, in turn
  std::vector<std::int32_t> xx_, xy_, yy_;  // products of gradients, summed over those rows
};

}  // namespace rotrocc
