#include "input/stereo_pair_converter.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <opencv2/imgproc.hpp>

#include "input/input_error.h"
#include "input/mask_file.h"
#include "input/message_conversion.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr std::uint32_t kMinSize_px = 16;

/// Pixel layout of a sensor_msgs/Image.
struct ImageEncoding {
  static constexpr int kIsGrey = -1;

  const char* name;
  int cv_type;
  int to_grey;  // of cv::cvtColor, or kIsGrey

  bool isGrey() const { return to_grey == kIsGrey; }
  bool has16Bits() const { return CV_MAT_DEPTH(cv_type) == CV_16U; }
};

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

void validateSides(const std::string& side, const sensor_msgs::Image& image) {
  const auto is = [&] {
    return "the " + side + " image is " + sizeText(image.width, image.height);
  };
  if (image.width < kMinSize_px || image.height < kMinSize_px) {
    throw InputError(DropReason::kImageSize,
                     is() + ", but each side must be " + toText(kMinSize_px) +
                         " px or more: check the camera driver");
  }
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  if (pixels <= StereoPairConverter::kMaxPixels) return;
  throw InputError(DropReason::kImageSize,
                   is() + ", more than " + toText(StereoPairConverter::kMaxPixels) +
                       " pixels: bin the images in the driver");
}

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

void validateImage(const char* side, const sensor_msgs::Image& image) {
  const ImageEncoding& encoding = encodingOf(side, image);
  validateSides(side, image);
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

void validatePair(const sensor_msgs::Image& left, const sensor_msgs::Image& right) {
  validateImage("left", left);
  validateImage("right", right);
  if (left.width == right.width && left.height == right.height) return;
  throw InputError(DropReason::kImageSizesDiffer,
                   "the left image is " + sizeText(left.width, left.height) + ", the right one " +
                       sizeText(right.width, right.height) +
                       ": set both cameras to the same resolution");
}

/// Value of a 16-bit pixel, for any byte order of this machine.
int value16(const unsigned char* bytes, bool big_endian) {
  return big_endian ? bytes[0] << 8 | bytes[1] : bytes[1] << 8 | bytes[0];
}

/// Share of the pixels that may be brighter than the range in use.
constexpr double kBrighterShare = 0.01;

/// Number of bits that all but the brightest pixels of a 16-bit image use; at least 8, and 8 of
/// others.
int countSignificantBits(const sensor_msgs::Image& image) {
  if (!encodingOf("", image).has16Bits()) return 8;  // left and right may differ
  std::array<std::size_t, 256> counts = {};          // by the upper byte
  for (std::size_t y = 0; y < image.height; ++y) {
    const unsigned char* row = image.data.data() + y * image.step;
    for (std::size_t x = 0; x < image.width; ++x) {
      ++counts[static_cast<std::size_t>(value16(row + 2 * x, image.is_bigendian != 0) >> 8)];
    }
  }
  const double admitted = kBrighterShare * static_cast<double>(image.width) * image.height;
  std::size_t brighter = 0;
  std::size_t upper = counts.size();
  while (upper > 1 && static_cast<double>(brighter + counts[upper - 1]) <= admitted) {
    brighter += counts[--upper];
  }
  int bits = 8;
  for (std::size_t rest = upper - 1; rest != 0; rest >>= 1) ++bits;
  return bits;
}

void scaleTo8Bits(const sensor_msgs::Image& image, int significant_bits, cv::Mat& pixels) {
  const int shift = significant_bits - 8;
  pixels.create(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC1);
  for (int y = 0; y < pixels.rows; ++y) {
    const unsigned char* from = image.data.data() + static_cast<std::size_t>(y) * image.step;
    unsigned char* to = pixels.ptr(y);
    for (int x = 0; x < pixels.cols; ++x, from += 2) {
      const int value = value16(from, image.is_bigendian != 0) >> shift;
      to[x] = static_cast<unsigned char>(std::min(value, 255));
    }
  }
}

/// The data of an image with 8 bits.
cv::Mat pixelsOf(const sensor_msgs::Image& image, const ImageEncoding& encoding) {
  return cv::Mat(static_cast<int>(image.height),
                 static_cast<int>(image.width),
                 encoding.cv_type,
                 const_cast<unsigned char*>(image.data.data()),
                 image.step);
}

cv::Mat toGrey(const sensor_msgs::Image& image,
               const ImageEncoding& encoding,
               int significant_bits,
               StereoPairConverter::Buffers& buffers) {
  if (encoding.has16Bits()) scaleTo8Bits(image, significant_bits, buffers.scaled);
  const cv::Mat pixels = encoding.has16Bits() ? buffers.scaled : pixelsOf(image, encoding);
  if (encoding.isGrey()) return pixels;
  cv::cvtColor(pixels, buffers.grey, encoding.to_grey);
  return buffers.grey;
}

}  // namespace

StereoPairConverter::StereoPairConverter(int significant_bits, const std::string& mask)
    : known_bits_(significant_bits), mask_(mask) {
  if (mask.empty()) return;
  left_mask_ = readMask(pathOfSide(mask, "left"));
  right_mask_ = readMask(pathOfSide(mask, "right"));
}

StereoPair StereoPairConverter::convert(const sensor_msgs::Image& left,
                                        const sensor_msgs::Image& right) {
  validatePair(left, right);
  validateMasks(left);
  const ImageEncoding& left_encoding = encodingOf("left", left);
  const ImageEncoding& right_encoding = encodingOf("right", right);
  findSignificantBits(left, right);
  return {toNanoseconds(left.header.stamp),
          toGrey(left, left_encoding, significant_bits_, left_buffers_),
          toGrey(right, right_encoding, significant_bits_, right_buffers_),
          left_mask_,
          right_mask_};
}

void StereoPairConverter::validateMasks(const sensor_msgs::Image& left) const {
  if (mask_.empty()) return;
  const cv::Size size(static_cast<int>(left.width), static_cast<int>(left.height));
  for (const bool is_left : {true, false}) {
    const cv::Mat& mask = is_left ? left_mask_ : right_mask_;
    if (mask.size() == size) continue;
    throw InputError(DropReason::kImageSize,
                     "the images are " + sizeText(left.width, left.height) + ", but the mask " +
                         pathOfSide(mask_, is_left ? "left" : "right") + " is " +
                         sizeText(mask.cols, mask.rows) +
                         ": make it from an image as the camera takes them");
  }
}

void StereoPairConverter::findSignificantBits(const sensor_msgs::Image& left,
                                              const sensor_msgs::Image& right) {
  if (known_bits_ > 0) {
    significant_bits_ = known_bits_;
    return;
  }
  if (!encodingOf("left", left).has16Bits() && !encodingOf("right", right).has16Bits()) {
    recent_bits_.clear();  // another mode of the camera says nothing of this one
    significant_bits_ = 8;
    return;
  }
  recent_bits_.push_back(std::max(countSignificantBits(left), countSignificantBits(right)));
  if (recent_bits_.size() > kShrinkPairs) recent_bits_.pop_front();
  if (recent_bits_.size() == 1) significant_bits_ = recent_bits_.back();
  if (recent_bits_.size() < 2) return;
  const int in_two = std::min(recent_bits_.back(), *(recent_bits_.rbegin() + 1));
  significant_bits_ = std::max(significant_bits_, in_two);
  if (recent_bits_.size() < kShrinkPairs) return;
  const int in_all = *std::max_element(recent_bits_.begin(), recent_bits_.end());
  significant_bits_ = std::min(significant_bits_, in_all);
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
  if (left.header.frame_id.empty()) {
    throw InputError(DropReason::kFrameMissing,
                     "the left image has an empty frame_id: set it in the driver, or set the "
                     "parameter camera_frame");
  }
  return withoutSlash(left.header.frame_id);
}

}  // namespace rotrocc
