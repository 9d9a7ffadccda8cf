#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace rotrocc {

/// Two rectified images taken at the same time, CV_8UC1 and of the camera's size. The pixels are
/// not copied: whoever created the cv::Mat must not change them until process() returns.
struct StereoPair {
  std::int64_t stamp_ns = 0;
  cv::Mat left;
  cv::Mat right;

  /// Where they are not zero, e.g. because the robot itself is in view, there are no features. Of
  /// the type and the size of the images, or empty: features may be anywhere. Masks are kept, so
  /// their pixels must never change.
  cv::Mat left_mask = {};
  cv::Mat right_mask = {};

  /// By how much the clock of the stamps was set forward since the first pair: the time from
  /// one pair to the next is the difference of time_ns().
  std::int64_t clock_set_ns = 0;
  std::int64_t time_ns() const { return stamp_ns - clock_set_ns; }
  double stamp_sigma_s = 0.0;  ///< standard deviation of the error of the stamp
};

}  // namespace rotrocc
