#pragma once

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

namespace rotrocc {

/// The image that the transport "compressed" of image_transport makes of a message, but with
/// colours always as bgr8 or bgra8. Throws InputError if it cannot be decoded.
sensor_msgs::Image::Ptr decode(const sensor_msgs::CompressedImage& message);

}  // namespace rotrocc
