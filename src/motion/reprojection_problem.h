#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/image_grid.h"
#include "kernels/kernels.h"
#include "motion/feature_errors.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Standard deviation of a disparity over that of a flow.
constexpr double kDisparityNoiseRatio = 4.0;

/// Neighboring features share an error of their disparities: what calibration and rectification
/// leave of the lenses, and texture that their windows have in common. The image is divided into
/// cells, and the features of a cell share one unknown error.
///
/// What the lenses leave is also smooth over the whole image, see smoothErrors().
struct SharedErrorGrid : ImageGrid {
  static constexpr int kColumns = 12;
  static constexpr int kRows = 4;
  static constexpr std::size_t kCells = kColumns * kRows;

  explicit SharedErrorGrid(const StereoCamera& camera)
      : ImageGrid(camera.width, camera.height, kColumns, kRows) {}

  /// y^2, x^2 and x y of a cell, where x and y are -1 and 1 at the borders of the image. On KITTI
  /// most of the errors are y^2.
  static Eigen::Vector3d smoothErrors(std::size_t cell) {
    const double x = (2.0 * static_cast<double>(cell % kColumns) + 1.0) / kColumns - 1.0;
    const double y = (2.0 * static_cast<double>(cell / kColumns) + 1.0) / kRows - 1.0;
    return {y * y, x * x, x * y};
  }
};

/// Ratio of the standard deviation of a smooth error at the borders to that of a flow.
constexpr double kSmoothRatio = 1.8;

/// Least squares over the whitened reprojection errors W (keyframe_px - pi(R X_cur + T)) [px] of
/// the features of a pair (Eq. 25, and with a fixed rotation Eq. 29).
///
/// The noise of the disparities is accounted for: with j = d pi(R X + T) / d disparity and r =
/// Measurements::noise_ratio, a residual has the covariance S = I + r^2 j j^T in units of the
/// flow's variance, and W = S^-1/2. Residuals are linearized at the disparity that fits both of its
/// measurements best: noisy far points would bias the translation towards zero. Their least squares
/// have the same minimum as least squares over the motion and all true disparities (Deming
/// regression). A ratio of 0 gives the paper's least squares.
class ReprojectionProblem {
 public:
  static constexpr int kColumns = LinearBlock::kColumns;

  /// sum w [J r]^T [J r]: J^T J, with J^T r in the last column and r^T r in the lower right corner.
  using NormalMatrix = Eigen::Matrix<double, kColumns, kColumns>;

  /// The residual of one feature.
  struct Term {
    std::size_t feature;  ///< index among all features of the pair
    double weight;        ///< of both rows
    Eigen::Vector2d residual_px;
    Eigen::Matrix<double, 2, 6> jacobian;
    Eigen::Vector2d by_disparity;  ///< derivative by an error of the disparity, up to the sign
  };

  /// Takes all features, with equal weights, and the motion at which disparities are fitted.
  void assign(const Measurements& measured, const Eigen::Isometry3d& T_keyframe_cur);

  const Eigen::Isometry3d& motion() const { return T_keyframe_cur_; }
  /// Also fits the disparities there.
  void setMotion(const Eigen::Isometry3d& T_keyframe_cur);

  /// Equal weights for the features flagged in `set`, 0 for the others. Without shared errors.
  void select(const FeatureSet& set);

  /// Multiplies the weights by cauchyWeights() of the residuals at motion(), with the given factor.
  /// Returns their standard deviation.
  double weigh(double robust_factor);

  /// Replaces the weights by their squares.
  void squareWeights();

  /// Adds an unknown for each cell of SharedErrorGrid, a disparity error that its features share,
  /// with a standard deviation of `cell_ratio` times the flow noise, and one for each of its
  /// smoothErrors(), with `smooth_ratio` times the flow noise; 0: there are none. The unknowns are
  /// eliminated (Schur complement) from normalMatrix().
  void shareErrors(double cell_ratio, double smooth_ratio);

  /// The normal matrix at a motion: columns of LinearBlock from `first` on, the others are zero.
  NormalMatrix normalMatrix(const Eigen::Isometry3d& T_keyframe_cur, int first) const;

  /// |r| of all features at motion() [px], whatever their weights.
  void errors(std::vector<double>& errors_px) const;

  /// Calls visit(const Term&) for each feature with a weight, in order, at a motion.
  template <class Visit>
  void visit(const Eigen::Isometry3d& T_keyframe_cur, const Visit& visit) const {
    const FeatureView view = viewFrom(T_keyframe_cur);
    LinearBlock linear;
    for (std::size_t i = 0; i < count_; ++i) {
      const FeatureBlock& block = blocks_[i / kSize];
      if (i % kSize == 0) chooseKernels().linearize(view, LinearBlock::kBias, block, linear);
      if (block.weight[i % kSize] > 0.0) visit(termOf(i, block, linear));
    }
  }

 private:
  static constexpr std::size_t kSize = FeatureBlock::kSize;

  FeatureView viewFrom(const Eigen::Isometry3d& T_keyframe_cur) const;
  double& weightOf(std::size_t i) { return blocks_[i / kSize].weight[i % kSize]; }
  static Term termOf(std::size_t i, const FeatureBlock& block, const LinearBlock& linear);

  StereoCamera camera_;
  double noise_ratio_ = 0.0;
  Eigen::Isometry3d T_keyframe_cur_ = Eigen::Isometry3d::Identity();
  std::size_t count_ = 0;
  std::vector<FeatureBlock> blocks_;
  double cell_ratio_ = 0.0;                  // 0: no shared errors
  double smooth_ratio_ = 0.0;                // 0: no smooth ones
  std::vector<Eigen::Index> cells_;          // of SharedErrorGrid
  std::vector<double> errors_px_, weights_;  // reused
};

}  // namespace rotrocc
