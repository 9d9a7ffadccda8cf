#pragma once

#include <cstdint>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "input/image_validation.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Converts the images of a pair to grey images for the estimator. See encodingOf() for supported
/// encodings.
///
/// 16-bit images of 10 or 12-bit cameras use only a part of their range. They are shifted right by
/// b - 8 bits, where b is the number of bits of the largest value in any image so far, at least 8.
/// So both images of a pair have the same scale, which stays constant once a camera has used its
/// full range.
class StereoPairConverter {
 public:
  static constexpr std::int64_t kMaxPixels = 50'000'000;

  explicit StereoPairConverter(std::int64_t max_pixels = kMaxPixels) : max_pixels_(max_pixels) {}

  /// The resulting images refer to the data of `left` and `right` if these are 8-bit grey,
  /// otherwise to a buffer that the next call overwrites. They must not be modified. The stamp is
  /// the left one. Throws InputError like validatePair().
  StereoPair convert(const sensor_msgs::Image& left, const sensor_msgs::Image& right);

 private:
  struct Buffers {
    cv::Mat scaled;  // to 8 bits
    cv::Mat grey;
  };

  cv::Mat toGrey(const sensor_msgs::Image& image,
                 const ImageEncoding& encoding,
                 Buffers& buffers) const;

  std::int64_t max_pixels_;
  int significant_bits_ = 8;
  Buffers left_buffers_;
  Buffers right_buffers_;
};

}  // namespace rotrocc
