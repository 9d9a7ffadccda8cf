#include "motion/motion_estimator.h"

#include <Eigen/Cholesky>

#include "motion/outlier_rejection.h"

namespace rotrocc {
namespace {

/// 99 % quantile of the chi-squared distribution with 6 degrees of freedom.
constexpr double kSignificant2 = 16.8;

/// The square of a factor of 2 between distances.
constexpr double kHalf2 = 4.0;

}  // namespace

MotionEstimator::MotionEstimator(const Config& config, int least_inliers)
    : config_(config), least_inliers_(least_inliers), two_stages_(config), covariance_(config) {
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
  estimateFrom(near_, measured, initial, dt_s, retry_);
  return isLikelier(retry_, initial) ? retry_ : found_;
}

/// Whether the retry is more plausible than the first motion.
bool MotionEstimator::isLikelier(const Estimate& retry, const Eigen::Isometry3d& prediction) const {
  if (!retry.valid || !found_.valid) return retry.valid;
  const int inliers = count(retry.rotation_inliers);
  const int inliers_before = count(found_.rotation_inliers);
  if (2 * inliers < inliers_before) return false;
  if (inliers > 2 * inliers_before) return true;
  const Eigen::LDLT<Matrix6d> uncertainty(found_.covariance + retry.covariance);
  const auto distance2 = [&](const Eigen::Isometry3d& T_a, const Eigen::Isometry3d& T_b) {
    Vector6d difference;
    difference << T_a.translation() - T_b.translation(),
        logRotation(T_a.linear() * T_b.linear().transpose());
    return difference.dot(uncertainty.solve(difference));
  };
  return distance2(retry.T_keyframe_cur, found_.T_keyframe_cur) > kSignificant2 &&
         kHalf2 * distance2(retry.T_keyframe_cur, prediction) <
             distance2(found_.T_keyframe_cur, prediction);
}

void MotionEstimator::estimateFrom(const FeatureSet& set,
                                   const Measurements& measured,
                                   const Eigen::Isometry3d& initial,
                                   double dt_s,
                                   Estimate& estimate) {
  RobustRefinement* refinement = refinement_ ? &*refinement_ : nullptr;
  two_stages_.estimate(measured, set, initial, dt_s, least_inliers_, refinement, motion_);
  estimate.T_keyframe_cur = motion_.fit.T_keyframe_cur;
  estimate.rotation_inliers = motion_.rotation_inliers;
  estimate.translation_inliers = motion_.translation_inliers;
  estimate.has_translation_stage = motion_.has_translation_stage;
  estimate.translation_failed = motion_.translation_failed;
  estimate.covariance.setZero();
  estimate.flow_noise_px = 0.0;
  estimate.valid =
      motion_.valid &&
      covariance_.estimate(measured, motion_, estimate.covariance, estimate.flow_noise_px);
}

}  // namespace rotrocc
