#pragma once

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Turns the images of a pair into the grey ones that the estimator takes. Encodings: mono8, 8UC1,
/// mono16, 16UC1, rgb8, bgr8, rgba8, bgra8 and 8-bit Bayer.
///
/// 16-bit images of 10 or 12-bit cameras use a part of their range only. They lose their last b - 8
/// bits, where b is the number of bits of the greatest value in any image so far, at least 8. So
/// the two images of a pair are scaled alike, and the scale stays once a camera has shown its
/// range.
class StereoPairConverter {
 public:
  /// The images of the result refer to the bytes of `left` and `right` where these are grey
  /// already, and else to memory of this object that the next call overwrites. They must not be
  /// written to. The stamp is the left one. Throws std::invalid_argument, before it reads a pixel,
  /// if the sizes, the step, the length of the data or the encoding of an image are wrong, or if
  /// the two differ in size.
  StereoPair convert(const sensor_msgs::Image& left, const sensor_msgs::Image& right);

 private:
  int significant_bits_ = 8;
  cv::Mat left_buffer_;
  cv::Mat right_buffer_;
};

/// Throws std::invalid_argument with both sizes if the images do not fit the camera.
void requireSize(const StereoPair& pair, const StereoCamera& camera);

}  // namespace rotrocc
