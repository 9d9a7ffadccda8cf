#include "input/stereo_pair_converter.h"

#include <algorithm>
#include <cstdint>

#include <opencv2/imgproc.hpp>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

/// Value of a 16-bit pixel, for any byte order of this machine.
int value16(const unsigned char* bytes, bool big_endian) {
  return big_endian ? bytes[0] << 8 | bytes[1] : bytes[1] << 8 | bytes[0];
}

/// Number of bits of the largest value of a 16-bit image.
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

void scaleTo8Bits(const sensor_msgs::Image& image, int significant_bits, cv::Mat& pixels) {
  const int shift = significant_bits - 8;
  pixels.create(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC1);
  for (int y = 0; y < pixels.rows; ++y) {
    const unsigned char* from = image.data.data() + static_cast<std::size_t>(y) * image.step;
    unsigned char* to = pixels.ptr(y);
    for (int x = 0; x < pixels.cols; ++x, from += 2) {
      to[x] = static_cast<unsigned char>(value16(from, image.is_bigendian != 0) >> shift);
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

}  // namespace

StereoPair StereoPairConverter::convert(const sensor_msgs::Image& left,
                                        const sensor_msgs::Image& right) {
  validatePair(left, right, max_pixels_);
  const ImageEncoding& left_encoding = encodingOf("left", left);
  const ImageEncoding& right_encoding = encodingOf("right", right);
  if (left_encoding.has16Bits()) {
    significant_bits_ = std::max(significant_bits_, countSignificantBits(left));
  }
  if (right_encoding.has16Bits()) {
    significant_bits_ = std::max(significant_bits_, countSignificantBits(right));
  }
  return {toNanoseconds(left.header.stamp),
          toGrey(left, left_encoding, left_buffers_),
          toGrey(right, right_encoding, right_buffers_)};
}

cv::Mat StereoPairConverter::toGrey(const sensor_msgs::Image& image,
                                    const ImageEncoding& encoding,
                                    Buffers& buffers) const {
  if (encoding.has16Bits()) scaleTo8Bits(image, significant_bits_, buffers.scaled);
  const cv::Mat pixels = encoding.has16Bits() ? buffers.scaled : pixelsOf(image, encoding);
  if (encoding.isGrey()) return pixels;
  cv::cvtColor(pixels, buffers.grey, encoding.to_grey);
  return buffers.grey;
}

}  // namespace rotrocc
