#pragma once

#include "kernels/instructions.h"

namespace rotrocc {

/// A block of features whose disparities are fitted, see fitAt().
struct FitBlock {
  static constexpr int kSize = 16;
  using Numbers = double[kSize];

  Numbers keyframe_x, keyframe_y;     ///< [px]
  Numbers point_x, point_y, point_z;  ///< in the current camera frame [m]
  Numbers measured;                   ///< measured disparity, above the disparity at infinity [px]

  // Results, as in FittedFeature.
  Numbers target_x, target_y;
  Numbers rotated_x, rotated_y, rotated_z;
  Numbers whitening_xx, whitening_xy, whitening_yy;
  Numbers slope_x, slope_y;

  // Intermediate values: R X times disparity, current fitted disparity, its projection [px].
  Numbers ray_x, ray_y, ray_z;
  Numbers fitted;
  Numbers seen_x, seen_y;
};

/// The motion, camera and options of the fit.
struct FitTerms {
  double rotation[9];  ///< row by row
  double translation[3];
  double fx, fy, cx, cy;
  double least_depth;  ///< closer points are projected as if they were at this depth [m]
  double ratio2;       ///< squared ratio of disparity noise to flow noise
  int steps;           ///< number of steps of the fit
};

namespace ROTROCC_INSTRUCTIONS {

void fitDisparities(FitTerms terms, FitBlock& block);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
