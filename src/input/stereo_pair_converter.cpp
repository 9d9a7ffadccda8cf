#include "input/stereo_pair_converter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/algorithm/string/replace.hpp>
#include <boost/make_shared.hpp>
#include <opencv2/imgproc.hpp>

#include "files/image_file.h"
#include "input/input_error.h"
#include "input/message_conversion.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

namespace enc = sensor_msgs::image_encodings;

constexpr std::uint32_t kMinSize_px = 16;
/// More than any stereo camera has: their pyramids and features take 1 GB.
constexpr std::uint64_t kMaxPixels = 50'000'000;

/// cv_bridge does not know it.
const char* const kYuy2 = "yuv422_yuy2";

/// Untrusted text, quoted for the log.
std::string quote(const std::string& text) {
  constexpr std::size_t kMaxLength = 40;
  std::string quoted = "\"";
  for (const char c : text.substr(0, kMaxLength)) quoted += c >= ' ' && c <= '~' ? c : '?';
  return quoted + (text.size() > kMaxLength ? "...\"" : "\"");
}

[[noreturn]] void rejectEncoding(const std::string& side, const std::string& encoding) {
  const bool is_float = encoding.find("FC") != std::string::npos;
  throw InputError(DropReason::kImageEncoding,
                   "the " + side + " image has the encoding " + quote(encoding) +
                       ", but must be one of: mono8 mono16 rgb8 bgr8 rgba8 bgra8 yuv422 " + kYuy2 +
                       " bayer_rggb8 bayer_bggr8 bayer_gbrg8 bayer_grbg8, those of 16 bits, or "
                       "8UC1 8UC3 8UC4 16UC1" +
                       (is_float ? " (is its topic remapped to a depth image?)" : ""));
}

std::uint64_t bytesPerPixel(const std::string& side, const std::string& encoding) {
  if (encoding == kYuy2) return 2;
  const bool has_gray_levels = enc::isMono(encoding) || enc::isColor(encoding) ||
                               enc::isBayer(encoding) || encoding == enc::YUV422 ||
                               encoding.find("UC") != std::string::npos;
  if (!has_gray_levels) rejectEncoding(side, encoding);
  try {
    return static_cast<std::uint64_t>(enc::numChannels(encoding) * enc::bitDepth(encoding) / 8);
  } catch (const std::runtime_error&) {
    rejectEncoding(side, encoding);
  }
}

/// Checks the header before a pixel is read.
void validate(const std::string& side, const sensor_msgs::Image& image) {
  const std::uint64_t row_bytes = image.width * bytesPerPixel(side, image.encoding);
  const std::uint64_t bytes = std::uint64_t{image.step} * image.height;
  const std::string is = "the " + side + " image is " + sizeText(image.width, image.height);
  const std::string has = "the " + side + " image has ";
  if (std::min(image.width, image.height) < kMinSize_px) {
    throw InputError(DropReason::kImageSize,
                     is + ", but each side must be " + toText(kMinSize_px) +
                         " px or more: check the camera driver");
  }
  if (std::uint64_t{image.width} * image.height > kMaxPixels) {
    throw InputError(
        DropReason::kImageSize,
        is + ", more than " + toText(kMaxPixels) + " pixels: bin the images in the driver");
  }
  if (image.step < row_bytes) {
    throw InputError(DropReason::kImageStep,
                     has + "a step of " + toText(image.step) + " bytes, but " +
                         toText(image.width) + " px of " + image.encoding + " take " +
                         toText(row_bytes) + ": the driver's encoding or step is wrong");
  }
  if (image.data.size() < bytes) {
    throw InputError(DropReason::kImageData,
                     has + toText(image.data.size()) + " bytes of data, but " +
                         toText(image.height) + " rows of " + toText(image.step) + " bytes take " +
                         toText(bytes) + ": the driver sends incomplete images");
  }
}

void validate(const ReceivedPair& received) {
  const sensor_msgs::Image& left = *received.images.left;
  const sensor_msgs::Image& right = *received.images.right;
  validate("left", left);
  validate("right", right);
  const std::string left_size = sizeText(left.width, left.height);
  const std::string right_size = sizeText(right.width, right.height);
  const std::string camera_size = sizeText(received.camera.width, received.camera.height);
  if (left_size != right_size) {
    throw InputError(DropReason::kImageSizesDiffer,
                     "the left image is " + left_size + ", the right one " + right_size +
                         ": set both cameras to the same resolution");
  }
  if (left_size != camera_size) {
    throw InputError(DropReason::kImageNotOfCamera,
                     "the images are " + left_size + ", but camera_info is for " + camera_size +
                         ": calibrate at this resolution, or set binning and roi in camera_info");
  }
}

/// The image of a checked message, in the byte order of this machine; without a copy if that is so.
cv_bridge::CvImage read(const std::string& side, const sensor_msgs::Image& image) {
  const std::size_t bytes = std::size_t{image.step} * image.height;
  const cv::Size size(static_cast<int>(image.width), static_cast<int>(image.height));
  if (image.encoding == kYuy2) {
    auto* const data = const_cast<unsigned char*>(image.data.data());
    return {image.header, kYuy2, cv::Mat(size, CV_8UC2, data, image.step)};
  }
  try {
    cv_bridge::CvImageConstPtr bridged;
    if (image.data.size() > bytes) {  // cv_bridge rejects more
      sensor_msgs::Image shortened = image;
      shortened.data.resize(bytes);
      bridged = cv_bridge::toCvCopy(shortened);
    } else {
      bridged = cv_bridge::toCvShare(image, nullptr);
    }
    // It leaves the type of bytes to those that it has swapped.
    const int type = cv_bridge::getCvType(image.encoding);
    if (bridged->image.type() == type) return *bridged;
    const cv::Mat typed(size, type, bridged->image.data, bridged->image.step);
    return {image.header, image.encoding, typed.clone()};
  } catch (const std::runtime_error&) {
    rejectEncoding(side, image.encoding);
  }
}

/// The values of a 16-bit image without the darkest and the brightest hundredth of its pixels;
/// those of 8 bits for others.
cv::Vec2i usedValues(const cv::Mat& image) {
  if (image.depth() != CV_16U) return {0, 255};  // left and right may differ
  constexpr double kLeftOut = 0.01;
  constexpr int kBins = 65536;
  const std::vector<cv::Mat> values = {image.reshape(1)};
  cv::Mat counts;
  cv::calcHist(values, {0}, cv::noArray(), counts, {kBins}, {0.0f, 65536.0f});
  const double admitted = kLeftOut * static_cast<double>(values[0].total());
  double brighter = 0.0, darker = 0.0;
  int upper = kBins - 1, lower = 0;
  while (upper > 0 && (brighter += counts.at<float>(upper)) <= admitted) --upper;
  while (lower < upper && (darker += counts.at<float>(lower)) <= admitted) ++lower;
  return {lower, upper};
}

/// At least 8.
int bitsOf(int value) {
  int bits = 8;
  while (value >> bits != 0) ++bits;
  return bits;
}

/// With a margin for what comes, if there is a black level.
GrayRange rangeOf(const cv::Vec2i& used) {
  constexpr int kUnusedBits = 2;
  const GrayRange from_zero = {0, bitsOf(used[1])};
  if (used[0] == used[1]) return from_zero;  // a shutter, or no light
  const int margin = (used[1] - used[0]) / 4;
  const int black = std::max(used[0] - margin, 0);
  const GrayRange from_black = {black, bitsOf(used[1] - black)};
  return from_black.bits + kUnusedBits <= from_zero.bits ? from_black : from_zero;
}

cv::Mat toGray(const std::string& side, const cv_bridge::CvImage& image, const GrayRange& range) {
  cv::Mat pixels = image.image;
  std::string encoding = image.encoding;
  if (pixels.depth() == CV_16U) {
    const double scale = std::ldexp(1.0, 8 - range.bits);
    // Rounded down, as a shift is.
    image.image.convertTo(pixels, CV_8U, scale, 0.5 * (scale - 1.0) - scale * range.black);
    encoding.replace(encoding.find("16"), 2, "8");
  }
  if (encoding == enc::MONO8 || encoding == enc::TYPE_8UC1) return pixels;
  if (encoding == kYuy2) {
    cv::Mat luma;
    cv::extractChannel(pixels, luma, 0);
    return luma;
  }
  if (encoding == enc::TYPE_8UC3) encoding = enc::BGR8;
  if (encoding == enc::TYPE_8UC4) encoding = enc::BGRA8;
  try {
    const auto bridged = boost::make_shared<cv_bridge::CvImage>(image.header, encoding, pixels);
    return cv_bridge::cvtColor(bridged, enc::MONO8)->image;
  } catch (const cv_bridge::Exception&) {
    rejectEncoding(side, image.encoding);
  }
}

std::string pathOfSide(const std::string& path, const std::string& side) {
  return boost::algorithm::replace_first_copy(path, "%s", side);
}

/// 255 where the image is not black, 0 elsewhere.
cv::Mat readMask(const std::string& path) {
  try {
    return readGrayImageOfAnyDepth(std::filesystem::absolute(path).string()) > 0;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(std::string("the mask ") + error.what() +
                             "; check the parameter mask");
  }
}

}  // namespace

StereoPairConverter::StereoPairConverter(int significant_bits, const std::string& mask)
    : known_bits_(significant_bits), mask_(mask) {
  if (mask.empty()) return;
  left_mask_ = readMask(pathOfSide(mask, "left"));
  right_mask_ = readMask(pathOfSide(mask, "right"));
}

StereoPair StereoPairConverter::convert(const ReceivedPair& received) {
  validate(received);
  const cv_bridge::CvImage left = read("left", *received.images.left);
  const cv_bridge::CvImage right = read("right", *received.images.right);
  validateMasks(left.image.size());
  findRange(left.image, right.image);
  StereoPair pair = {toNanoseconds(left.header.stamp),
                     toGray("left", left, range_),
                     toGray("right", right, range_),
                     left_mask_,
                     right_mask_};
  if (received.calibration) pair = rectifier_.rectify(pair, received.calibration);
  pair.clock_set_ns = received.clock_set_ns;
  pair.stamp_sigma_s = received.stamp_sigma_s;
  return pair;
}

void StereoPairConverter::validateMasks(const cv::Size& size) const {
  if (mask_.empty()) return;
  for (const bool is_left : {true, false}) {
    const cv::Mat& mask = is_left ? left_mask_ : right_mask_;
    if (mask.size() == size) continue;
    throw InputError(DropReason::kImageSize,
                     "the images are " + sizeText(size.width, size.height) + ", but the mask " +
                         pathOfSide(mask_, is_left ? "left" : "right") + " is " +
                         sizeText(mask.cols, mask.rows) +
                         ": make it from an image as the camera takes them");
  }
}

void StereoPairConverter::findRange(const cv::Mat& left, const cv::Mat& right) {
  if (known_bits_ > 0) {
    range_ = {known_black_, known_bits_};
    return;
  }
  if (left.depth() != CV_16U && right.depth() != CV_16U) {
    recent_.clear();  // another mode of the camera says nothing of this one
    range_ = {};
    return;
  }
  const cv::Vec2i of_left = usedValues(left), of_right = usedValues(right);
  recent_.emplace_back(std::min(of_left[0], of_right[0]), std::max(of_left[1], of_right[1]));
  if (recent_.size() > kShrinkPairs) recent_.pop_front();
  const cv::Vec2i &last = recent_.back(),
                  &before = recent_[std::max<std::size_t>(recent_.size(), 2) - 2];
  if (recent_.size() == 1) used_ = last;
  used_ = {std::min(used_[0], std::max(last[0], before[0])),
           std::max(used_[1], std::min(last[1], before[1]))};
  if (recent_.size() == kShrinkPairs) {
    cv::Vec2i all = last;
    for (const cv::Vec2i& one : recent_) all = {std::min(all[0], one[0]), std::max(all[1], one[1])};
    used_ = {std::max(used_[0], all[0]), std::min(used_[1], all[1])};
  }
  range_ = rangeOf(used_);
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
