#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// An image and its smaller copies (CV_8UC1), each half as wide and high as the one before.
using ImagePyramid = std::vector<cv::Mat>;

/// Builds a pyramid of at most `levels`, the image included, of which the smaller copies are larger
/// than `least_side_px` in both directions. Reuses the memory of `pyramid`.
void buildPyramid(const cv::Mat& image, int levels, int least_side_px, ImagePyramid& pyramid);

/// Smooths `image` (CV_8UC1) by (1 4 6 4 1) / 16 in both directions and keeps every other pixel of
/// every other row, the first ones included: the reduction of Burt and Adelson (1983). Beyond its
/// edge the image is reflected. `half` is as wide and high as half the image, rounded up; its
/// memory is reused.
void halve(const cv::Mat& image, cv::Mat& half);

}  // namespace rotrocc
