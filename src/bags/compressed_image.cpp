#include "bags/compressed_image.h"

#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgcodecs.hpp>

#include "input/input_error.h"
#include "input/message_conversion.h"

namespace rotrocc {
namespace {

namespace enc = sensor_msgs::image_encodings;

/// Empty if it has none. `format` is "ENCODING; jpeg compressed ..."; older drivers omit it.
std::string encodingOf(const cv::Mat& pixels, const std::string& format) {
  const std::string recorded = format.substr(0, format.find(';'));
  switch (pixels.type()) {
    case CV_8UC1:
      return enc::isBayer(recorded) ? recorded : enc::MONO8;
    case CV_16UC1:
      return enc::isBayer(recorded) ? recorded : enc::MONO16;
    case CV_8UC3:
      return enc::BGR8;
    case CV_8UC4:
      return enc::BGRA8;
    default:
      return "";
  }
}

}  // namespace

sensor_msgs::Image::Ptr decode(const sensor_msgs::CompressedImage& message) {
  cv::Mat pixels;
  try {
    if (!message.data.empty()) pixels = cv::imdecode(message.data, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // too many pixels
    pixels.release();
  }
  const std::string encoding = encodingOf(pixels, message.format);
  if (!pixels.empty() && !encoding.empty()) return toImage(message.header, encoding, pixels);
  throw InputError(DropReason::kImageData,
                   "a compressed image with " + std::to_string(message.data.size()) +
                       " bytes and the format \"" + message.format +
                       "\" cannot be decoded as grey or colour image: is it damaged, or a depth "
                       "image?");
}

}  // namespace rotrocc
