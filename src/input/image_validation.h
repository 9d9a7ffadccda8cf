#pragma once

#include <cstdint>
#include <string>

#include <sensor_msgs/Image.h>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Pixel layout of a sensor_msgs/Image.
struct ImageEncoding {
  enum class Layout { kGrey, kGrey16, kColour };

  const char* name;
  Layout layout;
  int cv_type;
  int to_grey;  ///< of cv::cvtColor, for kColour
};

/// These functions check the header of an image against its data before a pixel is read. They throw
/// InputError with the value and a remedy. `side` is "left" or "right".

/// Supports mono8, 8UC1, mono16, 16UC1, rgb8, bgr8, rgba8, bgra8 and 8-bit Bayer.
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
