#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The disparity bias that the features of one pair show.
struct BiasMeasurement {
  double bias_px = 0.0;    ///< relative to the camera that was passed
  double noise_px2 = 0.0;  ///< variance by the noise of single features
  /// Variance by errors that neighbouring features share, if these are as large as the noise.
  double shared_px2 = 0.0;
  /// Estimated variance of the shared errors, divided by that of the noise. Its expectation is
  /// right, but a single value may be negative.
  double shared_ratio2 = 0.0;
  Vector6d motion_by_bias = Vector6d::Zero();  ///< translation, then rotation
};

/// Measures the disparity bias of single pairs: with biased disparities, no motion explains both
/// near and far points. The bias is one more unknown of Eq. 25, estimated together with the motion.
///
/// Neighbouring features share errors: of lenses and rectification, of matching at edges. In the
/// model, all features in a cell of the image have a common disparity error. Its variance is
/// estimated by the method of moments (DerSimonian and Laird 1986) from the amount by which the
/// cells disagree about the bias beyond their noise.
class BiasMeter {
 public:
  BiasMeter(double noise_ratio, double robust_factor)
      : noise_ratio_(noise_ratio), robust_factor_(robust_factor) {}

  /// Starts at the given motion, with depths as triangulated for `camera`. Returns false if the
  /// flagged features do not determine a bias, as at standstill.
  bool measure(const StereoCamera& camera,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_keyframe_cur,
               BiasMeasurement& measurement);

 private:
  static constexpr int kColumns = 6;
  static constexpr int kRows = 3;
  static constexpr int kCells = kColumns * kRows;
  using PerCell = Eigen::Matrix<double, kCells, 1>;

  /// Sums over the features: the normal equations of the motion and of one disparity error per
  /// cell.
  struct Sums {
    Matrix6d motion = Matrix6d::Zero();
    Eigen::Matrix<double, 6, kCells> motion_by_cell = Eigen::Matrix<double, 6, kCells>::Zero();
    PerCell cells = PerCell::Zero();
    Vector6d motion_residual = Vector6d::Zero();
    PerCell cell_residual = PerCell::Zero();
    double squared_weights = 0.0;
    WeightedVariance variance;
  };

  /// The same equations without the motion: information * errors = weighted.
  struct Cells {
    Eigen::Matrix<double, kCells, kCells> information;
    PerCell weighted;
    PerCell of_bias;  ///< information times an error of all cells alike
    double bias_information;
    double bias_px;
    Vector6d motion_by_bias;  ///< rotation, then translation
    Vector6d motion_step;     ///< likewise
  };

  /// Of the robust cost: that of reweighted least squares, which never overshoots, or its
  /// expectation, which has the squared weights (see MotionCovariance).
  enum class Curvature { kConvex, kExpected };

  Sums collect(Curvature curvature);
  void sumEquations(Sums& sums) const;
  static Cells eliminateMotion(const Sums& sums);
  static bool describe(const Sums& sums, const Cells& cells, BiasMeasurement& measurement);

  double noise_ratio_;
  double robust_factor_;

  // The current step of one measurement, reused.
  StereoCamera camera_;
  Correspondences features_;
  Eigen::Isometry3d T_keyframe_cur_ = Eigen::Isometry3d::Identity();
  Fit fit_;
  FeatureSet all_;
  ReprojectionProblem<6> problem_;
};

}  // namespace rotrocc
