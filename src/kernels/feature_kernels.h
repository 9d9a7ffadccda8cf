#pragma once

#include "kernels/instructions.h"

namespace rotrocc {

/// The motion and camera at which features are projected.
struct MotionTerms {
  double rotation[9];  ///< row by row
  double translation[3];
  double fx, fy, cx, cy;
  double least_depth;  ///< closer points are projected as if they were at this depth [m]
};

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

/// A block of features whose residuals are linearized, see ReprojectionProblem.
struct ResidualBlock {
  static constexpr int kSize = 8;
  using Numbers = double[kSize];

  Numbers target_x, target_y;         ///< from the principal point [px]
  Numbers point_x, point_y, point_z;  ///< in the axes of the keyframe's camera [m]
  Numbers whitening_xx, whitening_xy, whitening_yy;
  /// Derivative of the residual by an error of the disparity.
  Numbers by_disparity_x, by_disparity_y;
  Numbers weight;  ///< 0: no feature
};

/// Whitened residuals of a block and their derivatives: three by a rotation, three by the
/// translation, and the residual as the seventh.
struct LinearBlock {
  static constexpr int kColumns = 7;
  static constexpr int kTranslation = 3;
  static constexpr int kResidual = 6;

  ResidualBlock::Numbers x[kColumns], y[kColumns];  ///< of both rows of a residual [px]
};

/// Sums over features of the products of two columns, each in as many parts as a block has
/// features.
struct ColumnProducts {
  ResidualBlock::Numbers of[LinearBlock::kColumns][LinearBlock::kColumns];
};

namespace ROTROCC_INSTRUCTIONS {

/// Fits the disparities to the measurements in `steps` steps. `ratio2` is the squared ratio of
/// disparity noise to flow noise.
void fitDisparities(MotionTerms terms, double ratio2, int steps, FitBlock& block);

/// Columns from `first` on: all, those from kTranslation, or kResidual alone.
void linearize(MotionTerms terms, int first, const ResidualBlock& block, LinearBlock& linear);

/// Adds the weighted products of column `first` and the following ones, each with itself and those
/// after it.
void addColumnProducts(int first,
                       const ResidualBlock& block,
                       const LinearBlock& linear,
                       ColumnProducts& sums);

/// Weighted products of the derivative by an error of the disparity with itself, and with the
/// columns from `first` on.
void multiplyByDisparity(int first,
                         const ResidualBlock& block,
                         const LinearBlock& linear,
                         ResidualBlock::Numbers& squares,
                         ResidualBlock::Numbers* products);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
