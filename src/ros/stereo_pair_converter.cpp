#include "stereo_pair_converter.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgproc.hpp>

#include "message_conversion.h"
#include "to_text.h"

namespace rotrocc {
namespace {

namespace encodings = sensor_msgs::image_encodings;

constexpr std::uint32_t kMinSize_px = 16;
constexpr std::uint32_t kMaxSize_px = 16384;

enum class Layout { kGrey, kGrey16, kColour };

struct Encoding {
  const std::string& name;
  Layout layout;
  int cv_type;
  int to_grey;  // of cv::cvtColor, for kColour
};

/// OpenCV names a Bayer pattern by pixels 2 and 3 of row 2, ROS by pixels 1 and 2 of rows 1 and 2.
const Encoding kEncodings[] = {
    {encodings::MONO8, Layout::kGrey, CV_8UC1, 0},
    {encodings::TYPE_8UC1, Layout::kGrey, CV_8UC1, 0},
    {encodings::MONO16, Layout::kGrey16, CV_16UC1, 0},
    {encodings::TYPE_16UC1, Layout::kGrey16, CV_16UC1, 0},
    {encodings::RGB8, Layout::kColour, CV_8UC3, cv::COLOR_RGB2GRAY},
    {encodings::BGR8, Layout::kColour, CV_8UC3, cv::COLOR_BGR2GRAY},
    {encodings::RGBA8, Layout::kColour, CV_8UC4, cv::COLOR_RGBA2GRAY},
    {encodings::BGRA8, Layout::kColour, CV_8UC4, cv::COLOR_BGRA2GRAY},
    {encodings::BAYER_RGGB8, Layout::kColour, CV_8UC1, cv::COLOR_BayerBG2GRAY},
    {encodings::BAYER_BGGR8, Layout::kColour, CV_8UC1, cv::COLOR_BayerRG2GRAY},
    {encodings::BAYER_GBRG8, Layout::kColour, CV_8UC1, cv::COLOR_BayerGR2GRAY},
    {encodings::BAYER_GRBG8, Layout::kColour, CV_8UC1, cv::COLOR_BayerGB2GRAY}};

const Encoding& findEncoding(const char* side, const sensor_msgs::Image& image) {
  std::string known;
  for (const Encoding& encoding : kEncodings) {
    if (encoding.name == image.encoding) return encoding;
    known += " " + encoding.name;
  }
  throw std::invalid_argument(std::string("the ") + side + " image has the encoding \"" +
                              image.encoding + "\", but must have one of:" + known);
}

void checkLayout(const std::string& side,
                 const sensor_msgs::Image& image,
                 const Encoding& encoding) {
  for (const std::uint32_t size : {image.width, image.height}) {
    if (size >= kMinSize_px && size <= kMaxSize_px) continue;
    throw std::invalid_argument("the " + side + " image is " + sizeText(image.width, image.height) +
                                ", but each side must be " + toText(kMinSize_px) + " to " +
                                toText(kMaxSize_px) + " px");
  }
  const std::uint64_t row_bytes = std::uint64_t{image.width} * CV_ELEM_SIZE(encoding.cv_type);
  if (image.step < row_bytes) {
    throw std::invalid_argument("the " + side + " image has a step of " + toText(image.step) +
                                " bytes, but " + toText(image.width) + " px of " + image.encoding +
                                " take " + toText(row_bytes));
  }
  const std::uint64_t bytes = std::uint64_t{image.step} * image.height;
  if (image.data.size() < bytes) {
    throw std::invalid_argument("the " + side + " image has " + toText(image.data.size()) +
                                " bytes of data, but " + toText(image.height) + " rows of " +
                                toText(image.step) + " bytes take " + toText(bytes));
  }
}

/// Value of a 16-bit pixel, whatever the byte order of this machine.
int value16(const unsigned char* bytes, bool big_endian) {
  return big_endian ? bytes[0] << 8 | bytes[1] : bytes[1] << 8 | bytes[0];
}

/// Bits of the greatest value of a 16-bit image.
int countSignificantBits(const sensor_msgs::Image& image) {
  int any = 0;
  for (std::size_t y = 0; y < image.height; ++y) {
    const unsigned char* row = image.data.data() + y * image.step;
    for (std::size_t x = 0; x < image.width; ++x) {
      any |= value16(row + 2 * x, image.is_bigendian != 0);
    }
  }
  int bits = 0;
  for (; any != 0; any >>= 1) ++bits;
  return bits;
}

void scaleTo8Bits(const sensor_msgs::Image& image, int significant_bits, cv::Mat& grey) {
  const int shift = significant_bits - 8;
  grey.create(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC1);
  for (int y = 0; y < grey.rows; ++y) {
    const unsigned char* from = image.data.data() + static_cast<std::size_t>(y) * image.step;
    unsigned char* to = grey.ptr(y);
    for (int x = 0; x < grey.cols; ++x, from += 2) {
      to[x] = static_cast<unsigned char>(value16(from, image.is_bigendian != 0) >> shift);
    }
  }
}

cv::Mat toGrey(const sensor_msgs::Image& image,
               const Encoding& encoding,
               int significant_bits,
               cv::Mat& buffer) {
  if (encoding.layout == Layout::kGrey16) {
    scaleTo8Bits(image, significant_bits, buffer);
    return buffer;
  }
  const cv::Mat pixels(static_cast<int>(image.height),
                       static_cast<int>(image.width),
                       encoding.cv_type,
                       const_cast<unsigned char*>(image.data.data()),
                       image.step);
  if (encoding.layout == Layout::kGrey) return pixels;
  cv::cvtColor(pixels, buffer, encoding.to_grey);
  return buffer;
}

}  // namespace

StereoPair StereoPairConverter::convert(const sensor_msgs::Image& left,
                                        const sensor_msgs::Image& right) {
  const Encoding& left_encoding = findEncoding("left", left);
  const Encoding& right_encoding = findEncoding("right", right);
  checkLayout("left", left, left_encoding);
  checkLayout("right", right, right_encoding);
  if (left.width != right.width || left.height != right.height) {
    throw std::invalid_argument("the left image is " + sizeText(left.width, left.height) +
                                ", the right one " + sizeText(right.width, right.height));
  }
  if (left_encoding.layout == Layout::kGrey16) {
    significant_bits_ = std::max(significant_bits_, countSignificantBits(left));
  }
  if (right_encoding.layout == Layout::kGrey16) {
    significant_bits_ = std::max(significant_bits_, countSignificantBits(right));
  }
  return {toNanoseconds(left.header.stamp),
          toGrey(left, left_encoding, significant_bits_, left_buffer_),
          toGrey(right, right_encoding, significant_bits_, right_buffer_)};
}

void requireSize(const StereoPair& pair, const StereoCamera& camera) {
  if (pair.left.cols == camera.width && pair.left.rows == camera.height) return;
  throw std::invalid_argument("the images are " + sizeText(pair.left.cols, pair.left.rows) +
                              ", but camera_info is for " + sizeText(camera.width, camera.height));
}

}  // namespace rotrocc
