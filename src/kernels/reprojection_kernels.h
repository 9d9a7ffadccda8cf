#pragma once

#include "kernels/instructions.h"

namespace rotrocc {

/// The camera of the keyframe, and how it sees the points of the current one.
struct FeatureView {
  const double* T;       ///< the motion (R, T) as 4 x 4 numbers, column by column [m]; not owned
  double fx, fy;         ///< [px]
  double least_depth_m;  ///< smaller depths are replaced by it
  bool is_seen;          ///< FeatureBlock::seen is at this motion
};

/// Features that are processed together: for each number, an array over all of them.
struct FeatureBlock {
  static constexpr int kSize = 8;
  using Numbers = double[kSize];

  /// The features at a motion.
  struct Seen {
    Numbers turned_x, turned_y, turned_z;  ///< R X_cur
    Numbers in_front;                      ///< 1, or 0 if the depth is limited
    Numbers per_z, u, v;                   ///< projection, from the principal point
  };

  Numbers target_x, target_y;  ///< keyframe_px, from the principal point
  Numbers x, y, z;             ///< X_cur at the measured disparity [m]
  Numbers disparity;           ///< measured, above that at infinity [px]
  Numbers moved;               ///< fitted less measured disparity [px]
  Numbers nearer;              ///< fitted depth over measured depth
  Numbers w_xx, w_xy, w_yy;    ///< W, see ReprojectionProblem
  Numbers by_x, by_y;          ///< W j
  Numbers weight;              ///< 0: not in the set, or no feature
  Seen seen;                   ///< at the motion for which disparities are fitted
};

/// Both rows of the linearized residuals of a block.
struct LinearBlock {
  /// Columns: derivatives by a bias of all disparities, by a rotation that follows the motion's and
  /// by the translation, and the residual itself.
  static constexpr int kBias = 0;
  static constexpr int kMotion = 1;
  static constexpr int kTranslation = 4;
  static constexpr int kResidual = 7;
  static constexpr int kColumns = 8;

  using Products = FeatureBlock::Numbers[kColumns];

  FeatureBlock::Numbers x[kColumns], y[kColumns];
};

namespace ROTROCC_INSTRUCTIONS {

/// Fits the disparities at a motion, and fills `seen` and all that depends on them.
void fitDisparities(const FeatureView& view, double noise_ratio, FeatureBlock& block);

/// The residuals at a motion: column kBias, and those from `first` on.
void linearize(const FeatureView& view, int first, const FeatureBlock& block, LinearBlock& linear);

/// Adds the weighted products of the columns from `first` on to `sums`: of each with itself and the
/// later ones. If `shared` is not null, it becomes the products of column kBias with itself and
/// with those.
void addProducts(const FeatureBlock& block,
                 const LinearBlock& linear,
                 int first,
                 LinearBlock::Products* sums,
                 FeatureBlock::Numbers* shared);

}  // namespace ROTROCC_INSTRUCTIONS
}  // namespace rotrocc
