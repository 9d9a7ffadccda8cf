#pragma once

#include <opencv2/core.hpp>

namespace rotrocc {

/// Smooths `image` (CV_8UC1) by (1 4 6 4 1) / 16 in both directions and keeps every other pixel of
/// every other row, the first ones included: the reduction of Burt and Adelson (1983). Beyond its
/// edge the image is reflected. `half` is as wide and high as half the image, rounded up; its
/// memory is used again.
void halve(const cv::Mat& image, cv::Mat& half);

}  // namespace rotrocc
