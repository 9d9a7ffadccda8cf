#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace rotrocc {

/// An image and its smaller copies (CV_8UC1), each half the width and height of the one before.
using ImagePyramid = std::vector<cv::Mat>;

/// Builds a pyramid of at most `levels` levels including the image. The smaller copies are larger
/// than `min_side_px` in both directions. Reuses the memory of `pyramid`.
inline void buildPyramid(const cv::Mat& image, int levels, int min_side_px, ImagePyramid& pyramid) {
  int count = 1;
  while (count < levels && std::min(image.cols, image.rows) >> count > min_side_px) ++count;
  pyramid.resize(static_cast<std::size_t>(count));
  image.copyTo(pyramid[0]);
  for (std::size_t i = 1; i < pyramid.size(); ++i) cv::pyrDown(pyramid[i - 1], pyramid[i]);
}

}  // namespace rotrocc
