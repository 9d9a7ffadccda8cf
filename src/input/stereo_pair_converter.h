#pragma once

#include <cstdint>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Turns the images of a pair into the grey ones that the estimator takes. encodingOf() tells which
/// encodings are known.
///
/// 16-bit images of 10 or 12-bit cameras use a part of their range only. They lose their last b - 8
/// bits, where b is the number of bits of the greatest value in any image so far, at least 8. So
/// the two images of a pair are scaled alike, and the scale stays once a camera has shown its
/// range.
class StereoPairConverter {
 public:
  static constexpr std::int64_t kMaxPixels = 50'000'000;

  explicit StereoPairConverter(std::int64_t max_pixels = kMaxPixels) : max_pixels_(max_pixels) {}

  /// The images of the result refer to the bytes of `left` and `right` where these are grey
  /// already, and else to memory of this object that the next call overwrites. They must not be
  /// written to. The stamp is the left one. Throws InputError as validatePair() does.
  StereoPair convert(const sensor_msgs::Image& left, const sensor_msgs::Image& right);

 private:
  std::int64_t max_pixels_;
  int significant_bits_ = 8;
  cv::Mat left_buffer_;
  cv::Mat right_buffer_;
};

}  // namespace rotrocc
