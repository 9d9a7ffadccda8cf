#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Parts of an image (CV_8UC1) of one size, inside of it; at least one.
struct ImagePatches {
  const cv::Mat& image;
  double noise_gray;  ///< standard deviation of the noise of the image
  std::vector<cv::Rect> areas;
};

/// Variance of the Gaussian by which the right image is more blurred than the left one [px^2], up
/// to 16; negative if the left one is, nan if noise hides it. The patches show the same in both
/// images. Gains and noise of the images do not matter.
double blurOfRight_px2(const ImagePatches& left, const ImagePatches& right);

}  // namespace rotrocc
