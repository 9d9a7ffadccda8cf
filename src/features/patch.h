#pragma once

#include <cstddef>
#include <cstdint>

#include <opencv2/core.hpp>

#include "kernels/window_kernels.h"

namespace rotrocc {

/// A distance of less than a pixel, in the units of Patch.
inline std::int16_t fractionOf(float distance_px) {
  return static_cast<std::int16_t>(32768.0F * distance_px);
}

/// The patch of an image whose pixel (radius, radius) is at `center`, all of it inside the image.
inline Patch patchAt(const cv::Mat& image, const cv::Point2f& center, int radius) {
  const int x = cvFloor(center.x);
  const int y = cvFloor(center.y);
  return {image.ptr<uchar>(y - radius) + x - radius,
          static_cast<std::ptrdiff_t>(image.step),
          fractionOf(center.x - static_cast<float>(x)),
          fractionOf(center.y - static_cast<float>(y))};
}

}  // namespace rotrocc
