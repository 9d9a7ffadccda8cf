#pragma once

#include <cstdint>
#include <string>

#include <opencv2/core/hal/interface.h>
#include <sensor_msgs/Image.h>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Pixel layout of a sensor_msgs/Image.
struct ImageEncoding {
  static constexpr int kIsGrey = -1;

  const char* name;
  int cv_type;
  int to_grey;  ///< of cv::cvtColor, or kIsGrey

  bool isGrey() const { return to_grey == kIsGrey; }
  bool has16Bits() const { return CV_MAT_DEPTH(cv_type) == CV_16U; }
};

/// These functions check the header of an image against its data before a pixel is read. They throw
/// InputError with the value and a remedy. `side` is "left" or "right".

/// Supports mono8, 8UC1, mono16, 16UC1, rgb8, bgr8, rgba8, bgra8, yuv422, yuv422_yuy2, and Bayer
/// patterns of 8 and 16 bits.
const ImageEncoding& encodingOf(const char* side, const sensor_msgs::Image& image);

/// Checks size, step and length of the data. Additional data is ignored. `max_pixels`: limit of
/// width times height.
void validateImage(const char* side, const sensor_msgs::Image& image, std::int64_t max_pixels);

/// Checks both images, and that their sizes are equal.
void validatePair(const sensor_msgs::Image& left,
                  const sensor_msgs::Image& right,
                  std::int64_t max_pixels);

/// Checks that the images have the size of camera_info.
void validateSize(const sensor_msgs::Image& left, const StereoCamera& camera);

/// The tf frame of the left camera: `camera_frame`, or if that is empty the frame of the image,
/// without the leading slash of older drivers.
std::string cameraFrameOf(const sensor_msgs::Image& left, const std::string& camera_frame);

}  // namespace rotrocc
