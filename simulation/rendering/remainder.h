#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What calibration leaves in the rectified images of one camera: a smooth field of offsets.
class Remainder {
 public:
  /// Coefficients [px] of 1, X, Y, X^2, X Y, Y^2, X^3, X^2 Y, X Y^2 and Y^3, for the columns and
  /// the rows. X and Y are 0 at the principal point and +-1 half an image away from it.
  using Coefficients = Eigen::Matrix<double, 2, 10>;

  Remainder(const Coefficients& coefficients, const StereoCamera& camera, double cx);

  /// What is seen at `pixel` should be seen this much [px] before it.
  Eigen::Vector2d at(const Eigen::Vector2d& pixel) const;

 private:
  Coefficients coefficients_;
  Eigen::Vector2d centre_;
  Eigen::Vector2d half_size_;
};

struct StereoRemainders {
  Remainder left;
  Remainder right;
};

/// Remainders for images of KITTI's size, and in proportion for others. Both cameras have that of
/// their lenses, 0.5 to 1 px, and a wrong principal point. In what they differ by, they are like
/// KITTI's: disparities are wrong by about 1.2 x^2 + 1.2 x y - 11 y^2 - 0.35 px in normalized
/// coordinates, and points are lower in the right image by about 7 x y px.
StereoRemainders randomRemainders(const StereoCamera& camera, std::uint64_t seed);

}  // namespace rotrocc
