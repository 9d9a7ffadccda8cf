#include "texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

#include "coverage.h"

namespace rotrocc {
namespace {

constexpr int kMaxTaps = 4;          // along the longer side of a pixel
constexpr float kLevelBias = 0.25F;  // the box filter between levels lets some aliases pass

bool isPowerOfTwo(int value) {
  return value > 0 && (value & (value - 1)) == 0;
}

/// The logarithm to base 2, linear between powers of two: at most 0.09 too small, and fast.
float roughLog2(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return static_cast<float>(bits) * 0x1.0p-23F - 127.0F;
}

std::vector<std::uint8_t> quantize(const cv::Mat& tile) {
  cv::Mat grey;
  tile.convertTo(grey, CV_8U, 255.0);
  return {grey.begin<std::uint8_t>(), grey.end<std::uint8_t>()};
}

}  // namespace

Texture::Texture(const cv::Mat& tile, double period_m) : texels_per_m_(tile.cols / period_m) {
  if (tile.type() != CV_32FC1 || tile.rows != tile.cols || !isPowerOfTwo(tile.cols)) {
    throw std::invalid_argument("a texture tile of " + std::to_string(tile.cols) + " x " +
                                std::to_string(tile.rows) +
                                " texels: make it CV_32FC1, square and a power of two");
  }
  cv::Mat level = tile;
  while (true) {
    levels_.push_back({level.cols,
                       static_cast<float>(level.cols) / static_cast<float>(tile.cols),
                       quantize(level)});
    if (level.cols == 1) break;
    cv::Mat half;
    cv::resize(level, half, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
    level = half;
  }
}

double Texture::at(const TexturePoint& point) const {
  // All in texels of the finest level.
  Eigen::Vector2f major = (texels_per_m_ * point.per_column).cast<float>();
  Eigen::Vector2f minor = (texels_per_m_ * point.per_row).cast<float>();
  if (major.squaredNorm() < minor.squaredNorm()) std::swap(major, minor);
  const float length = std::max(major.norm(), 1e-6F);
  // The width of the parallelogram that the pixel covers, not the length of its other side.
  const float width = std::abs(major.x() * minor.y() - major.y() * minor.x()) / length;
  // As many taps as the pixel is longer than wide, but no more than there are texels to see.
  int taps = 1;
  while (taps < kMaxTaps && length >= static_cast<float>(taps + 1) * std::max(width, 1.0F)) ++taps;
  const float per_tap = 1.0F / static_cast<float>(taps);
  const float detail = std::max(width, length * per_tap);

  const float last = static_cast<float>(levels_.size()) - 1.0F;
  const float level = std::clamp(roughLog2(detail) + kLevelBias, 0.0F, last);
  const int whole = static_cast<int>(level);
  const float share_of_next = level - static_cast<float>(whole);

  // Single precision is enough once whole periods are taken away.
  const double size = levels_.front().size;
  const Eigen::Vector2d at = texels_per_m_ * point.at;
  const Eigen::Vector2d periods(floorToInt(at.x() / size), floorToInt(at.y() / size));
  const Eigen::Vector2f step = per_tap * major;
  Eigen::Vector2f tap =
      (at - size * periods).cast<float>() - 0.5F * static_cast<float>(taps - 1) * step;
  float sum = 0.0F;
  for (int i = 0; i < taps; ++i, tap += step) {
    sum += trilinear(tap.x(), tap.y(), whole, share_of_next);
  }
  return sum * per_tap / 255.0F;
}

float Texture::trilinear(float u, float v, int level, float share_of_next) const {
  const float fine = levels_[level].bilinear(u, v);
  if (share_of_next <= 0.0F) return fine;
  return fine + share_of_next * (levels_[level + 1].bilinear(u, v) - fine);
}

float Texture::Level::bilinear(float u, float v) const {
  const float x = u * scale - 0.5F;
  const float y = v * scale - 0.5F;
  const int column = floorToInt(x);
  const int row = floorToInt(y);
  const float right = x - static_cast<float>(column);
  const float down = y - static_cast<float>(row);
  const int mask = size - 1;
  const std::uint8_t* upper = texels.data() + (row & mask) * size;
  const std::uint8_t* lower = texels.data() + ((row + 1) & mask) * size;
  const int a = column & mask;
  const int b = (column + 1) & mask;
  const float top = upper[a] + right * static_cast<float>(upper[b] - upper[a]);
  const float bottom = lower[a] + right * static_cast<float>(lower[b] - lower[a]);
  return top + down * (bottom - top);
}

}  // namespace rotrocc
