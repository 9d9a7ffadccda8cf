#pragma once

#include <cstdint>
#include <string>

#include <sensor_msgs/Image.h>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// How the pixels of a sensor_msgs/Image are to be read.
struct ImageEncoding {
  enum class Layout { kGrey, kGrey16, kColour };

  const char* name;
  Layout layout;
  int cv_type;
  int to_grey;  ///< of cv::cvtColor, for kColour
};

/// These check what the header of an image says against what it holds, before a pixel is read. They
/// throw InputError with the value and what to change. `side` is "left" or "right".

/// mono8, 8UC1, mono16, 16UC1, rgb8, bgr8, rgba8, bgra8 and 8-bit Bayer are known.
const ImageEncoding& encodingOf(const char* side, const sensor_msgs::Image& image);

/// Size, step and length of the data. More data than the rows take is left alone.
/// `max_pixels`: width times height may be at most that.
void validateImage(const char* side, const sensor_msgs::Image& image, std::int64_t max_pixels);

/// Both images, and that they are alike in size.
void validatePair(const sensor_msgs::Image& left,
                  const sensor_msgs::Image& right,
                  std::int64_t max_pixels);

/// That the images have the size of camera_info.
void validateSize(const sensor_msgs::Image& left, const StereoCamera& camera);

/// The tf frame of the left camera: `camera_frame`, or if that is empty the one the image names,
/// less the leading slash of older drivers.
std::string cameraFrameOf(const sensor_msgs::Image& left, const std::string& camera_frame);

}  // namespace rotrocc
