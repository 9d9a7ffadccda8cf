#pragma once

#include "motion/cauchy_weights.h"
#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "motion/two_stage_estimator.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// The covariance of an estimated motion, in the order of OdometryResult::covariance.
///
/// The covariance of the rotation comes from stage 1, with the translation marginalized. The
/// covariance of the translation comes from stage 2, plus the effect of the rotation's error dR:
///   dt = -(Jt^T Jt)^-1 Jt^T Jr dR.
/// Both follow the sandwich formula for robust weights (Huber's M-estimators). Both are inflated,
/// because neighbouring features share errors.
///
/// Stage 1 also drops features that are merely noisy. The remaining errors have only a share g of
/// the full variance. The covariance of the fit is that of a fit to untruncated errors, divided by
/// g (the sandwich formula, with both of its parts scaled by g).
class MotionCovariance {
 public:
  explicit MotionCovariance(const MotionEstimatorConfig& config)
      : is_truncated_(hasFixedLimit(criterionOf(config.criterion))),
        limit_px_(config.rotation_limit_px),
        robust_factor_(config.robust_factor) {}

  /// Sets the covariance and the noise, corrected for the dropped features, of a valid motion with
  /// its fit. Returns false if the features do not determine the motion.
  bool estimate(const Measurements& measured, const Fit& fit, MotionEstimate& motion);

 private:
  /// The parts of the covariance, in the order translation [m], rotation [rad].
  struct Information {
    /// Sum of w^2 J^T J: the derivative of the sum of w J^T r, which is zero at the solution, by
    /// the motion. (The derivative of w r, averaged over directions, is w^2.)
    Matrix6d matrix = Matrix6d::Zero();
    /// Sum of g g^T over the cells of a grid [px^2], where g is the sum of w J^T r of the features
    /// in the cell. Its expectation is the variance times `matrix` if residuals are uncorrelated,
    /// and larger if neighbours are correlated.
    Matrix6d scatter = Matrix6d::Zero();
    double residual_variance = 0.0;  ///< from WeightedVariance [px^2]
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
