#pragma once

#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "motion/two_stage_estimator.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Sets the covariance of a valid motion with its fit, in the order of OdometryResult::covariance,
/// and the noise of the flow, corrected for the dropped features. Returns false if the features do
/// not determine the motion. `problem` is a buffer.
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
bool estimateCovariance(const MotionEstimatorConfig& config,
                        const Measurements& measured,
                        const Fit& fit,
                        ReprojectionProblem<6>& problem,
                        MotionEstimate& motion);

}  // namespace rotrocc
