#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Checks the images of a pair, the header before a pixel is read, and converts them to grey images
/// for the estimator. Supports mono8, 8UC1, mono16, 16UC1, rgb8, bgr8, rgba8, bgra8, yuv422,
/// yuv422_yuy2, and Bayer patterns of 8 and 16 bits.
///
/// 16-bit images of 10 or 12-bit cameras use only a part of their range. They are shifted right by
/// b - 8 bits, where b is the number of bits in use, at least 8, and both images of a pair have the
/// same. Brighter pixels are white. A pair uses the bits of all but the brightest hundredth of its
/// pixels, so lamps, hot pixels and rows of metadata do not count. b grows when two pairs in a row
/// use more, and shrinks when kShrinkPairs use less, so a single bad image does not change it.
class StereoPairConverter {
 public:
  /// Larger images are no stereo camera's.
  static constexpr std::uint64_t kMaxPixels = 20'000'000;
  static constexpr std::size_t kShrinkPairs = 10;

  /// `significant_bits`: b if it is known, or 0. `mask`:
  /// path of a PNG file that is not black where pairs have no features (StereoPair::left_mask);
  /// with "%s" in place of left and right if there are two; empty: none. Throws std::runtime_error
  /// if it cannot be read.
  explicit StereoPairConverter(int significant_bits = 0, const std::string& mask = "");

  /// The resulting images refer to the data of `left` and `right` if these are 8-bit grey,
  /// otherwise to a buffer that the next call overwrites. They must not be modified. The stamp is
  /// the left one. Throws InputError with the value and a remedy on an unknown encoding, sizes out
  /// of range or that differ, also from those of the masks, and a step or data that are too short;
  /// more data is ignored.
  StereoPair convert(const sensor_msgs::Image& left, const sensor_msgs::Image& right);

  /// b of the last pair; 8 if it had no 16-bit image.
  int significantBits() const { return significant_bits_; }

  struct Buffers {
    cv::Mat scaled;  ///< to 8 bits
    cv::Mat grey;
  };

 private:
  void validateMasks(const sensor_msgs::Image& left) const;
  void findSignificantBits(const sensor_msgs::Image& left, const sensor_msgs::Image& right);

  int known_bits_;
  std::string mask_;
  cv::Mat left_mask_;
  cv::Mat right_mask_;
  int significant_bits_ = 8;
  std::deque<int> recent_bits_;  // of the last pairs
  Buffers left_buffers_;
  Buffers right_buffers_;
};

/// Throws InputError if the images have not the size of camera_info.
void validateSize(const sensor_msgs::Image& left, const StereoCamera& camera);

/// The tf frame of the left camera: `camera_frame`, or if that is empty the frame of the image,
/// without the leading slash of older drivers. Throws InputError if both are empty.
std::string cameraFrameOf(const sensor_msgs::Image& left, const std::string& camera_frame);

}  // namespace rotrocc
