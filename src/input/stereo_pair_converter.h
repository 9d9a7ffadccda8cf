#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "input/stereo_intake.h"
#include "rectification/stereo_rectifier.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// The values of a 16-bit image that become the gray levels from 0 to 255.
struct GrayRange {
  int black = 0;
  int bits = 8;  ///< so many values, to the power of two, from black on

  int white() const { return black + (1 << bits) - 1; }
};

/// Converts the images of a pair to gray images for the estimator, and rectifies raw ones. Supports
/// the encodings that cv_bridge converts to gray, yuv422_yuy2, and 8UC3 and 8UC4 as bgr8 and bgra8.
///
/// 16-bit images of 10 or 12-bit cameras use only a part of their range. They are shifted right by
/// b - 8 bits, where b is the number of bits in use, at least 8, and both images of a pair have the
/// same. Brighter pixels are white. A pair uses the bits of all but the brightest hundredth of its
/// pixels, so lamps, hot pixels and rows of metadata do not count. b grows when two pairs in a row
/// use more, and shrinks when kShrinkPairs use less, so a single bad image does not change it.
///
/// Thermal cameras use a small range far above zero. If that leaves at least two bits of b unused,
/// a black level below the darkest hundredth of the pixels is found in the same way, and subtracted
/// first.
class StereoPairConverter {
 public:
  static constexpr std::size_t kShrinkPairs = 10;

  /// `significant_bits`: b if it is known, without a black level, or 0. `mask`: path of an image
  /// that is not black where pairs have no features (StereoPair::left_mask); with "%s" in place of
  /// left and right if there are two; empty: none. Throws std::runtime_error if the mask cannot be
  /// read.
  explicit StereoPairConverter(int significant_bits = 0, const std::string& mask = "");

  /// Without a search for the range.
  StereoPairConverter(const GrayRange& range, const std::string& mask)
      : StereoPairConverter(range.bits, mask) {
    known_black_ = range.black;
  }

  /// Converts a pair, and rectifies it if it has a calibration. The resulting images refer to the
  /// data of the messages if these are rectified 8-bit gray images; rectified ones are valid until
  /// the next call. They must not be modified. The stamp is the left one. Throws InputError with
  /// the value and a remedy on an encoding that is not supported, sizes out of range or that
  /// differ, also from those of the camera or of the masks, and a step or data that are too short;
  /// more data is ignored.
  StereoPair convert(const ReceivedPair& received);

  /// Of the last pair.
  const GrayRange& grayRange() const { return range_; }

 private:
  void validateMasks(const cv::Size& size) const;
  void findRange(const cv::Mat& left, const cv::Mat& right);

  int known_bits_;
  int known_black_ = 0;
  std::string mask_;
  cv::Mat left_mask_;
  cv::Mat right_mask_;
  GrayRange range_;
  cv::Vec2i used_;                // from the darkest to the brightest value that counts
  std::deque<cv::Vec2i> recent_;  // of the last pairs
  StereoRectifier rectifier_;
};

/// The tf frame of the left camera: `camera_frame`, or if that is empty the frame of the image,
/// without the leading slash of older drivers. Throws InputError if both are empty.
std::string cameraFrameOf(const sensor_msgs::Image& left, const std::string& camera_frame);

}  // namespace rotrocc
