#include "motion/motion_estimator.h"

#include "motion/outlier_rejection.h"

namespace rotrocc {

MotionEstimator::MotionEstimator(const Config& config)
    : config_(config), two_stages_(config), covariance_(config) {
  if (config.robust_factor > 0.0) refinement_.emplace(config.robust_factor);
}

const MotionEstimator::Estimate& MotionEstimator::estimate(const StereoCamera& camera,
                                                           const Correspondences& features,
                                                           const Eigen::Isometry3d& initial,
                                                           double dt_s,
                                                           bool is_prediction) {
  const Measurements measured = {camera, features, config_.noise_ratio};
  all_.assign(features.size(), 1);
  estimateFrom(all_, measured, initial, dt_s, found_);
  const int agree = found_.valid ? count(found_.rotation_inliers) : 0;
  const bool few = agree < config_.retry_share * static_cast<double>(features.size());
  if (!few || !is_prediction || config_.retry_agreement_px == 0.0) return found_;

  fitAt(measured, initial, motion_.fit);
  fittedErrors(camera, motion_.fit, errors_px_);
  near_ = all_;
  keepBelow(errors_px_, config_.retry_agreement_px, near_);
  estimateFrom(near_, measured, initial, dt_s, other_);
  const auto deviation = [&](const Estimate& estimate) {
    return (estimate.T_prev_cur.translation() - initial.translation()).norm();
  };
  const bool likelier = other_.valid && 2 * count(other_.rotation_inliers) >= agree &&
                        (!found_.valid || deviation(other_) < deviation(found_));
  return likelier ? other_ : found_;
}

void MotionEstimator::estimateFrom(const FeatureSet& set,
                                   const Measurements& measured,
                                   const Eigen::Isometry3d& initial,
                                   double dt_s,
                                   Estimate& estimate) {
  RobustRefinement* refinement = refinement_ ? &*refinement_ : nullptr;
  two_stages_.estimate(measured, set, initial, dt_s, refinement, motion_);
  estimate.T_prev_cur = motion_.fit.T_prev_cur;
  estimate.rotation_inliers = motion_.rotation_inliers;
  estimate.translation_inliers = motion_.translation_inliers;
  estimate.has_translation_stage = motion_.has_translation_stage;
  estimate.covariance.setZero();
  estimate.flow_noise_px = 0.0;
  estimate.valid =
      motion_.valid &&
      covariance_.estimate(measured, motion_, estimate.covariance, estimate.flow_noise_px);
}

}  // namespace rotrocc
