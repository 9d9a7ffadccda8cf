#pragma once

#include "motion/cauchy_weights.h"
#include "motion/criterion.h"
#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "motion/two_stage_estimator.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// The covariance of an estimated motion, in the order of OdometryResult::covariance.
///
/// The rotation's comes from stage 1 with its translation marginalized; the translation's from
/// stage 2, plus what the rotation's error dR does to it: dt = -(Jt^T Jt)^-1 Jt^T Jr dR. Both are
/// those of a motion solved with robust weights (the sandwich formula of Huber's M-estimators),
/// inflated by what neighbours in the image share.
///
/// Features beyond the limit of stage 1 are dropped, though some are just noisy: what is left has
/// only a share g of the errors' variance, and a fit to it the variance of one to untruncated
/// errors over g (the sandwich formula, where both its parts are g).
class MotionCovariance {
 public:
  explicit MotionCovariance(const MotionEstimatorConfig& config)
      : is_truncated_(hasFixedLimit(criterionOf(config.criterion))),
        limit_px_(config.rotation_limit_px),
        robust_factor_(config.robust_factor) {}

  /// Returns false if the features do not determine the motion. `flow_noise_px` gets the standard
  /// deviation of the residuals in each direction, had none been dropped.
  bool estimate(const Measurements& measured,
                const TwoStageMotion& motion,
                Matrix6d& covariance,
                double& flow_noise_px);

 private:
  /// What the covariance is made of, in the order translation [m], rotation [rad].
  struct Information {
    /// Sum of w^2 J^T J: how the sum of w J^T r, which is zero at the solution, follows the motion.
    /// E[w^2] is the mean over the directions of the derivative of w r.
    Matrix6d matrix = Matrix6d::Zero();
    /// Sum over the cells of a grid of g g^T [px^2], g = w J^T r of the features in the cell: in
    /// the mean the variance times the matrix if no two residuals are correlated, more if
    /// neighbours are.
    Matrix6d scatter = Matrix6d::Zero();
    double residual_variance = 0.0;  ///< by WeightedVariance [px^2]
  };
  Information collect(const Measurements& measured,
                      const Fit& fit,
                      const FeatureSet& set,
                      int estimated_parameters);

  bool is_truncated_;
  double limit_px_;
  double robust_factor_;
  ReprojectionProblem<6> problem_;
};

}  // namespace rotrocc
