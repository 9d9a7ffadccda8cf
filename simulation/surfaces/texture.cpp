#include "simulation/surfaces/texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <opencv2/imgproc.hpp>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr int kMaxTaps = 4;          // along the longer side of a pixel
constexpr float kLevelBias = 0.25F;  // compensates for aliasing of the box filter between levels
constexpr float kOne = 65536.0F;     // a texel, in fixed point
constexpr int kHalf = 32768;

/// Fast logarithm to base 2, linear between powers of two: at most 0.09 too small.
float roughLog2(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return static_cast<float>(bits) * 0x1.0p-23F - 127.0F;
}

int sizeBits(const cv::Mat& tile) {
  int bits = 0;
  while (1 << bits < tile.cols) ++bits;
  return bits;
}

/// Repeats the first column and row at the end, for interpolation.
std::vector<std::uint8_t> quantize(const cv::Mat& tile) {
  cv::Mat repeated;
  cv::copyMakeBorder(tile, repeated, 0, 1, 0, 1, cv::BORDER_WRAP);
  cv::Mat gray;
  repeated.convertTo(gray, CV_8U, 255.0);
  return {gray.begin<std::uint8_t>(), gray.end<std::uint8_t>()};
}

}  // namespace

Texture::Texture(const cv::Mat& tile, double period_m)
    : periods_per_m_(1.0 / period_m), texels_per_period_(static_cast<float>(tile.cols)) {
  cv::Mat level = tile;
  while (true) {
    levels_.push_back({static_cast<int>(levels_.size()), sizeBits(level), quantize(level)});
    if (level.cols == 1) break;
    cv::Mat half;
    cv::resize(level, half, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
    level = half;
  }
}

double Texture::at(const TexturePoint& point) const {
  // All in texels of the finest level.
  const double texels_per_m = periods_per_m_ * texels_per_period_;
  Eigen::Vector2f major = (texels_per_m * point.per_column).cast<float>();
  Eigen::Vector2f minor = (texels_per_m * point.per_row).cast<float>();
  if (major.squaredNorm() < minor.squaredNorm()) std::swap(major, minor);
  const float squared_length = std::max(major.squaredNorm(), 1e-12F);
  // Width of the parallelogram that the pixel covers, not the length of its shorter side.
  const float area = major.x() * minor.y() - major.y() * minor.x();
  const float squared_width = area * area / squared_length;

  const Taps taps = tapsAlong(major, squared_length, squared_width, point.at);
  const float squared_detail = std::max(squared_width, squared_length * taps.share * taps.share);
  const float level = std::clamp(0.5F * roughLog2(squared_detail) + kLevelBias,
                                 0.0F,
                                 static_cast<float>(levels_.size()) - 1.0F);
  const int fine = static_cast<int>(level);
  const float share_of_next = level - static_cast<float>(fine);
  const float mean = levels_[fine].mean(taps);
  if (share_of_next <= 0.0F) return mean;
  return mean + share_of_next * (levels_[fine + 1].mean(taps) - mean);
}

Texture::Taps Texture::tapsAlong(const Eigen::Vector2f& line,
                                 float squared_length,
                                 float squared_width,
                                 const Eigen::Vector2d& middle_m) const {
  // By the aspect ratio of the pixel, but at most the number of visible texels.
  const float squared_tap = std::max(squared_width, 1.0F);
  int count = 1;
  while (count < kMaxTaps &&
         squared_length >= static_cast<float>((count + 1) * (count + 1)) * squared_tap) {
    ++count;
  }
  constexpr float kShares[] = {0.0F, 1.0F, 1.0F / 2.0F, 1.0F / 3.0F, 1.0F / 4.0F};
  static_assert(sizeof kShares == (kMaxTaps + 1) * sizeof kShares[0]);
  const float share = kShares[count];

  const float one_period = kOne * texels_per_period_;
  const auto step = [&](float texels) {  // the positions in a larger one do not matter
    return static_cast<int>(std::clamp(kOne * texels * share, -one_period, one_period));
  };
  const auto inPeriod = [&](double at_m) {
    const double periods = periods_per_m_ * at_m;
    return static_cast<int>(one_period * (periods - floorToInt(periods)));
  };
  Taps taps = {count, share, 0, 0, step(line.x()), step(line.y())};
  taps.u = inPeriod(middle_m.x()) - (count - 1) * taps.du / 2;
  taps.v = inPeriod(middle_m.y()) - (count - 1) * taps.dv / 2;
  return taps;
}

float Texture::Level::mean(const Taps& taps) const {
  const int mask = (1 << size_bits) - 1;
  const int stride = mask + 2;
  int sum = 0;
  for (int i = 0; i < taps.count; ++i) {
    // Bilinear; shares in 1/256, values in 1/65536.
    const int x = ((taps.u + i * taps.du) >> number) - kHalf;
    const int y = ((taps.v + i * taps.dv) >> number) - kHalf;
    const int right = (x >> 8) & 0xFF;
    const int down = (y >> 8) & 0xFF;
    const std::uint8_t* upper = texels.data() + ((y >> 16) & mask) * stride + ((x >> 16) & mask);
    const std::uint8_t* lower = upper + stride;
    const int top = 256 * upper[0] + right * (upper[1] - upper[0]);
    const int bottom = 256 * lower[0] + right * (lower[1] - lower[0]);
    sum += 256 * top + down * (bottom - top);
  }
  return static_cast<float>(sum) * taps.share * (1.0F / (255.0F * kOne));
}

}  // namespace rotrocc
