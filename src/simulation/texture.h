#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "simulation/surface_point.h"

namespace rotrocc {

/// A tile of values from 0 to 1 that is repeated over a plane. A lookup is the mean over the pixel,
/// also where that is much longer than wide (roads seen at a flat angle): detail below the size of
/// a pixel fades out instead of aliasing.
class Texture {
 public:
  /// `tile` is CV_32FC1, square, its side a power of two; it covers `period_m` x `period_m`.
  /// Throws std::invalid_argument if it is not.
  Texture(const cv::Mat& tile, double period_m);

  double at(const TexturePoint& point) const;

 private:
  /// Places in a line, in 1/65536 of a texel of the finest level.
  struct Taps {
    int count;
    float share;  // 1 / count
    int u, v;     // the first one
    int du, dv;   // from each to the next
  };

  struct Level {
    int number;                        // 0 is the finest
    int size_bits;                     // 2^size_bits texels a side
    std::vector<std::uint8_t> texels;  // with the first column and row once more at the end

    float mean(const Taps& taps) const;
  };

  Taps tapsAlong(const Eigen::Vector2f& line,
                 float squared_length,
                 float squared_width,
                 const Eigen::Vector2d& middle_m) const;

  double periods_per_m_;
  float texels_per_period_;
  std::vector<Level> levels_;  // each half the size of the one before it
};

}  // namespace rotrocc
