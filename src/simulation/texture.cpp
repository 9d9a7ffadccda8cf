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
constexpr double kLevelBias = 0.25;  // the box filter between levels lets some aliases pass

bool isPowerOfTwo(int value) {
  return value > 0 && (value & (value - 1)) == 0;
}

/// The logarithm to base 2, linear between powers of two: at most 0.09 too small, and fast.
double roughLog2(double value) {
  const auto single = static_cast<float>(value);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &single, sizeof bits);
  return static_cast<double>(bits) * 0x1.0p-23 - 127.0;
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
    levels_.push_back({level.cols, static_cast<float>(level.cols / period_m), quantize(level)});
    if (level.cols == 1) break;
    cv::Mat half;
    cv::resize(level, half, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
    level = half;
  }
}

double Texture::at(const TexturePoint& point) const {
  Eigen::Vector2d major = point.per_column;
  Eigen::Vector2d minor = point.per_row;
  if (major.squaredNorm() < minor.squaredNorm()) std::swap(major, minor);
  const double length_m = major.norm();
  // The width of the parallelogram that the pixel covers, not the length of its other side.
  const double width_m =
      std::abs(major.x() * minor.y() - major.y() * minor.x()) / std::max(length_m, 1e-12);
  // As many as the pixel is longer than wide, but no more than there are texels to see.
  const double wanted = std::min(length_m / std::max(width_m, 1e-12), length_m * texels_per_m_);
  const int taps = std::clamp(static_cast<int>(wanted), 1, kMaxTaps);
  const double detail_m = std::max(width_m, length_m / taps);

  const double last = static_cast<double>(levels_.size()) - 1.0;
  const double level = std::clamp(roughLog2(detail_m * texels_per_m_) + kLevelBias, 0.0, last);
  const int whole = static_cast<int>(level);
  const auto share_of_next = static_cast<float>(level - whole);

  // From here on single precision: what is left is less than a period.
  const double period_m = levels_[0].size / texels_per_m_;
  const Eigen::Vector2d tile(floorToInt(point.at.x() / period_m),
                             floorToInt(point.at.y() / period_m));
  const Eigen::Vector2f at = (point.at - period_m * tile).cast<float>();
  const Eigen::Vector2f step = (major / taps).cast<float>();
  Eigen::Vector2f tap = at - 0.5F * static_cast<float>(taps - 1) * step;
  float sum = 0.0F;
  for (int i = 0; i < taps; ++i, tap += step) {
    sum += trilinear(tap.x(), tap.y(), whole, share_of_next);
  }
  return sum / static_cast<float>(255 * taps);
}

float Texture::trilinear(float u, float v, int level, float share_of_next) const {
  const float fine = levels_[level].bilinear(u, v);
  if (share_of_next <= 0.0F) return fine;
  return fine + share_of_next * (levels_[level + 1].bilinear(u, v) - fine);
}

float Texture::Level::bilinear(float u, float v) const {
  const float x = u * texels_per_m - 0.5F;
  const float y = v * texels_per_m - 0.5F;
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
