#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "motion/cauchy_weights.h"
#include "motion/reprojection_error.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// How residuals count.
enum class Weights {
  kEqual,
  kRobust  ///< by CauchyWeights at the motion to begin with
};

/// Least squares over the reprojection errors of a feature set, by Levenberg-Marquardt.
class MotionSolver {
 public:
  /// `robust_factor`: of CauchyWeights.
  MotionSolver(double noise_ratio, double robust_factor)
      : noise_ratio_(noise_ratio), robust_weights_(robust_factor) {}

  /// What weights the residuals, see fitDisparities().
  void setNoiseRatio(double noise_ratio);

  /// The features that sets are of until the next call. They are referred to.
  void setFeatures(const StereoCamera& camera, const Correspondences& features);

  /// Minimises Eq. 25 over rotation and translation, from `T_prev_cur`, which gets the result. With
  /// robust weights it takes one step towards it: to be called repeatedly, from near the minimum.
  /// Returns false, and leaves it alone, if the set has fewer than 3 features or the result is not
  /// finite.
  bool solveMotion(const FeatureSet& set, Weights weights, Eigen::Isometry3d& T_prev_cur);

  /// Minimises Eq. 29 over the translation, the rotation staying as it is. Returns as
  /// solveMotion(), with 2 features at least.
  bool solveTranslation(const FeatureSet& set, Weights weights, Eigen::Isometry3d& T_prev_cur);

  /// reprojectionErrors() of all features, fitted at the motion [px].
  void measureErrors(const Eigen::Isometry3d& T_prev_cur, std::vector<double>& errors_px);

  /// What the covariance of a motion solved with robust weights w is made of (the sandwich formula
  /// of Huber's M-estimators), in the order translation [m], rotation [rad] of
  /// OdometryResult::covariance.
  struct Information {
    /// Sum of w^2 J^T J: how the sum of w J^T r, which is zero at the solution, follows the motion.
    /// E[w^2] is the mean over the directions of the derivative of w r.
    Matrix6d matrix = Matrix6d::Zero();
    /// Sum over the cells of a grid of g g^T [px^2], g = w J^T r of the features in the cell: in
    /// the mean the variance times the matrix if no two residuals are correlated, more if
    /// neighbours are.
    Matrix6d scatter = Matrix6d::Zero();
    double residual_variance = 0.0;  ///< of CauchyWeights [px^2]
  };
  Information information(const FeatureSet& set,
                          const Eigen::Isometry3d& T_prev_cur,
                          int estimated_parameters);

 private:
  const std::vector<FittedFeature>& fittedAt(const Eigen::Isometry3d& T_prev_cur);

  StereoCamera camera_;
  const Correspondences* features_ = nullptr;
  double noise_ratio_;
  CauchyWeights robust_weights_;
  ReprojectionProblem<6> motion_problem_;
  ReprojectionProblem<3> translation_problem_;
  std::vector<double> residuals_, jacobian_;

  // Rounds of outlier rejection solve where the one before measured, so the last fit is kept.
  bool has_fit_ = false;
  Eigen::Isometry3d fitted_T_prev_cur_;
  std::vector<FittedFeature> fitted_;
};

}  // namespace rotrocc
