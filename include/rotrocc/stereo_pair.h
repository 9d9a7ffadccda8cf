#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Two rectified images of one moment, CV_8UC1 and of the camera's size. Holds references: the
/// pixels belong to whoever made the cv::Mat and must stay as they are until process() has
/// returned.
struct StereoPair {
  std::int64_t stamp_ns = 0;
  cv::Mat left;
  cv::Mat right;
};

}  // namespace rotrocc
