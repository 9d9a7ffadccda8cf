#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "simulation/surfaces/surface_point.h"

namespace rotrocc {

/// A periodic tile of values from 0 to 1. A lookup averages over the pixel, also if its footprint
/// is elongated (roads at a flat angle): detail below pixel size fades out instead of aliasing.
class Texture {
 public:
  /// `tile` is CV_32FC1, square, its side a power of two; it covers `period_m` x `period_m`.
  Texture(const cv::Mat& tile, double period_m);

  double at(const TexturePoint& point) const;

 private:
  /// Sample positions on a line, in 1/65536 of a texel of the finest level.
  struct Taps {
    int count;
    float share;  // 1 / count
    int u, v;     // the first one
    int du, dv;   // from each to the next
  };

  struct Level {
    int number;                        // 0 is the finest
    int size_bits;                     // 2^size_bits texels a side
    std::vector<std::uint8_t> texels;  // with the first column and row repeated at the end

    float mean(const Taps& taps) const;
  };

  Taps tapsAlong(const Eigen::Vector2f& line,
                 float squared_length,
                 float squared_width,
                 const Eigen::Vector2d& middle_m) const;

  double periods_per_m_;
  float texels_per_period_;
  std::vector<Level> levels_;  // each half the size of the previous one
};

}  // namespace rotrocc
