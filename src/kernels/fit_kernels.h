#pragma once

#include "kernels/instructions.h"

namespace rotrocc {

/// Some features whose disparities are fitted, see fitAt().
struct FitBlock {
  static constexpr int kSize = 16;
  using Numbers = double[kSize];

  Numbers keyframe_x, keyframe_y;     ///< [px]
  Numbers point_x, point_y, point_z;  ///< in the current frame [m]
  Numbers measured;                   ///< disparity above that of infinity [px]

  // As in FittedFeature.
  Numbers target_x, target_y;
  Numbers rotated_x, rotated_y, rotated_z;
  Numbers whitening_xx, whitening_xy, whitening_yy;
  Numbers slope_x, slope_y;

  // On the way: R X times disparity, the disparity fitted so far, and the projection there [px].
  Numbers ray_x, ray_y, ray_z;
  Numbers fitted;
  Numbers seen_x, seen_y;
};

/// At what motion, by what camera and how.
struct FitTerms {
  double rotation[9];  ///< by rows
  double translation[3];
  double fx, fy, cx, cy;
  double least_depth;  ///< points nearer are projected as if they were there [m]
  double ratio2;       ///< square of the disparity's noise over that of the flow
  int steps;           ///< of the fit
};

namespace ROTROCC_INSTRUCTIONS {

void fitDisparities(FitTerms terms, FitBlock& block);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
