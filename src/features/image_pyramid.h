#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace rotrocc {

/// An image and its smaller copies (CV_8UC1), each half the width and height of the previous one.
using ImagePyramid = std::vector<cv::Mat>;

/// Builds a pyramid of at most `levels` levels including a copy of the image. The smaller copies
/// are larger than `min_side_px` in both directions. If there are any, `with_image` may be false:
/// then level 0 is empty. Reuses the memory of `pyramid`.
void buildPyramid(const cv::Mat& image,
                  int levels,
                  int min_side_px,
                  ImagePyramid& pyramid,
                  bool with_image = true);

/// Smooths `image` (CV_8UC1) by (1 4 6 4 1) / 16 in both directions and keeps every other pixel of
/// every other row, starting with the first: the reduction of Burt and Adelson (1983). The image is
/// reflected at its borders. `half` has half the width and height, rounded up; its memory is
/// reused.
void halve(const cv::Mat& image, cv::Mat& half);

/// Twice the width and height of `image` (CV_8UC1): pixel k becomes pixel 2k, those in between are
/// means of their neighbors, the last ones repeat. The memory of `large` is reused.
void enlarge(const cv::Mat& image, cv::Mat& large);

}  // namespace rotrocc
