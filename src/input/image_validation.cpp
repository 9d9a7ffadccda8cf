#include "input/image_validation.h"

#include <opencv2/imgproc.hpp>

#include "input/input_error.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::uint32_t kMinSize_px = 16;

/// OpenCV names a Bayer pattern by pixels 2 and 3 of row 2, ROS by pixels 1 and 2 of rows 1 and 2.
const ImageEncoding kEncodings[] = {{"mono8", CV_8UC1, ImageEncoding::kIsGrey},
                                    {"8UC1", CV_8UC1, ImageEncoding::kIsGrey},
                                    {"mono16", CV_16UC1, ImageEncoding::kIsGrey},
                                    {"16UC1", CV_16UC1, ImageEncoding::kIsGrey},
                                    {"rgb8", CV_8UC3, cv::COLOR_RGB2GRAY},
                                    {"bgr8", CV_8UC3, cv::COLOR_BGR2GRAY},
                                    {"rgba8", CV_8UC4, cv::COLOR_RGBA2GRAY},
                                    {"bgra8", CV_8UC4, cv::COLOR_BGRA2GRAY},
                                    {"yuv422", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
                                    {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2},
                                    {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2GRAY},
                                    {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2GRAY},
                                    {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2GRAY},
                                    {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2GRAY},
                                    {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2GRAY},
                                    {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2GRAY},
                                    {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2GRAY},
                                    {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2GRAY}};

/// Untrusted text, quoted for the log.
std::string quote(const std::string& text) {
  constexpr std::size_t kMaxLength = 40;
  std::string quoted = "\"";
  for (const char c : text.substr(0, kMaxLength)) quoted += c >= ' ' && c <= '~' ? c : '?';
  return quoted + (text.size() > kMaxLength ? "...\"" : "\"");
}

void validateSides(const std::string& side,
                   const sensor_msgs::Image& image,
                   std::int64_t max_pixels) {
  const auto is = [&] {
    return "the " + side + " image is " + sizeText(image.width, image.height);
  };
  if (image.width < kMinSize_px || image.height < kMinSize_px) {
    throw InputError(DropReason::kImageSize,
                     is() + ", but each side must be " + toText(kMinSize_px) +
                         " px or more: check the camera driver");
  }
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  if (pixels <= static_cast<std::uint64_t>(max_pixels)) return;
  throw InputError(DropReason::kImageSize,
                   is() + ", more than max_image_pixels = " + toText(max_pixels) +
                       ": raise that parameter, or bin the images in the driver");
}

}  // namespace

const ImageEncoding& encodingOf(const char* side, const sensor_msgs::Image& image) {
  for (const ImageEncoding& encoding : kEncodings) {
    if (image.encoding == encoding.name) return encoding;
  }
  std::string known;
  for (const ImageEncoding& encoding : kEncodings) known += std::string(" ") + encoding.name;
  const bool is_float = image.encoding.find("FC") != std::string::npos;
  throw InputError(DropReason::kImageEncoding,
                   std::string("the ") + side + " image has the encoding " + quote(image.encoding) +
                       ", but must be one of:" + known +
                       (is_float ? " (is its topic remapped to a depth image?)" : ""));
}

void validateImage(const char* side, const sensor_msgs::Image& image, std::int64_t max_pixels) {
  const ImageEncoding& encoding = encodingOf(side, image);
  validateSides(side, image, max_pixels);
  const std::uint64_t row_bytes = std::uint64_t{image.width} * CV_ELEM_SIZE(encoding.cv_type);
  const auto has = [&] { return std::string("the ") + side + " image has "; };
  if (image.step < row_bytes) {
    throw InputError(DropReason::kImageStep,
                     has() + "a step of " + toText(image.step) + " bytes, but " +
                         toText(image.width) + " px of " + image.encoding + " take " +
                         toText(row_bytes) + ": the driver's encoding or step is wrong");
  }
  const std::uint64_t bytes = std::uint64_t{image.step} * image.height;
  if (image.data.size() < bytes) {
    throw InputError(DropReason::kImageData,
                     has() + toText(image.data.size()) + " bytes of data, but " +
                         toText(image.height) + " rows of " + toText(image.step) + " bytes take " +
                         toText(bytes) + ": the driver sends incomplete images");
  }
}

void validatePair(const sensor_msgs::Image& left,
                  const sensor_msgs::Image& right,
                  std::int64_t max_pixels) {
  validateImage("left", left, max_pixels);
  validateImage("right", right, max_pixels);
  if (left.width == right.width && left.height == right.height) return;
  throw InputError(DropReason::kImageSizesDiffer,
                   "the left image is " + sizeText(left.width, left.height) + ", the right one " +
                       sizeText(right.width, right.height) +
                       ": set both cameras to the same resolution");
}

void validateSize(const sensor_msgs::Image& left, const StereoCamera& camera) {
  if (left.width == static_cast<std::uint32_t>(camera.width) &&
      left.height == static_cast<std::uint32_t>(camera.height)) {
    return;
  }
  throw InputError(DropReason::kImageNotOfCamera,
                   "the images are " + sizeText(left.width, left.height) +
                       ", but camera_info is for " + sizeText(camera.width, camera.height) +
                       ": calibrate at this resolution, or set binning and roi in camera_info");
}

std::string cameraFrameOf(const sensor_msgs::Image& left, const std::string& camera_frame) {
  if (!camera_frame.empty()) return camera_frame;
  const std::string& frame = left.header.frame_id;
  if (frame.empty()) {
    throw InputError(DropReason::kFrameMissing,
                     "the left image has an empty frame_id: set it in the driver, or set the "
                     "parameter camera_frame");
  }
  return frame.front() == '/' ? frame.substr(1) : frame;
}

}  // namespace rotrocc
