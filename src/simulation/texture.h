#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "surface_point.h"

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
  struct Level {
    int size;
    float scale;  // its texels per texel of the finest level
    std::vector<std::uint8_t> texels;

    float bilinear(float u, float v) const;
  };

  float trilinear(float u, float v, int level, float share_of_next) const;

  double texels_per_m_;
  std::vector<Level> levels_;  // each half the size of the one before it
};

}  // namespace rotrocc
