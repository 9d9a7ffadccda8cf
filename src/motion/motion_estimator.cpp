#include "motion/motion_estimator.h"

#include <utility>

#include <Eigen/Cholesky>

#include "motion/consensus_motion.h"
#include "motion/motion_covariance.h"
#include "motion/outlier_rejection.h"
#include "motion/reprojection_error.h"

namespace rotrocc {
namespace {

/// 99 % quantile of the chi-squared distribution with 6 degrees of freedom.
constexpr double kSignificant2 = 16.8;

/// If stage 1 leaves a smaller share of the features, the motion may be that of an object.
constexpr double kRetryShare = 0.7;

/// A smaller share of the features is not what most agree on.
constexpr double kMajority = 0.5;

/// Two sets of inliers that differ by less are of the same motion.
constexpr double kMinCountRatio = 1.1;

/// The square of a factor of 2 between distances.
constexpr double kHalf2 = 4.0;

/// Usual accelerations, which make a prediction by constant velocity wrong.
constexpr double kAcceleration_mps2 = 3.0;
constexpr double kAngularAcceleration_rps2 = 0.5;

Matrix6d covarianceOfPrediction(double dt_s) {
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(kAcceleration_mps2 * dt_s * dt_s),
      Eigen::Vector3d::Constant(kAngularAcceleration_rps2 * dt_s * dt_s);
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace

MotionEstimator::MotionEstimator(const Config& config, int min_inliers)
    : config_(config), two_stages_(config, min_inliers) {}

const MotionEstimator::Estimate& MotionEstimator::estimate(
    const StereoCamera& camera,
    const Correspondences& features,
    const Eigen::Isometry3d& initial,
    double dt_s,
    const std::optional<Prediction>& prediction,
    double shared_ratio) {
  const Measurements measured = {camera, features, config_.noise_ratio, shared_ratio};
  all_.assign(features.size(), 1);
  estimateFrom(all_, measured, initial, dt_s, found_);
  const int agree = found_.valid ? count(found_.rotation_inliers) : 0;
  const bool few = agree < kRetryShare * static_cast<double>(features.size());
  if (!few || config_.retry_agreement_px == 0.0) return found_;

  if (agree < kMajority * static_cast<double>(features.size())) takeConsensus(measured, dt_s);
  if (!prediction) return found_;
  retryNear(prediction->T_keyframe_cur, measured, dt_s);
  return isLikelier(retry_, *prediction) ? retry_ : found_;
}

/// The full set is a mixture of motions: its least squares fit may end at none of them, or at one
/// of the smaller part. Replaces it by the motion that most features agree on, if more do.
void MotionEstimator::takeConsensus(const Measurements& measured, double dt_s) {
  const auto consensus = consensusMotion(measured.camera, measured.features);
  if (!consensus) return;
  retryNear(*consensus, measured, dt_s);
  if (!retry_.valid) return;
  const double clearly_more = kMinCountRatio * count(found_.rotation_inliers);
  if (!found_.valid || count(retry_.rotation_inliers) > clearly_more) std::swap(found_, retry_);
}

/// Estimates from the features close to a motion.
void MotionEstimator::retryNear(const Eigen::Isometry3d& motion,
                                const Measurements& measured,
                                double dt_s) {
  // Without whitening, because the motion of an object along the road looks like a wrong disparity.
  reprojectionErrors(measured.camera, measured.features, motion, errors_px_);
  near_ = all_;
  keepBelow(errors_px_, config_.retry_agreement_px, near_);
  estimateFrom(near_, measured, motion, dt_s, retry_);
}

/// Whether the retry is more plausible than the first motion.
bool MotionEstimator::isLikelier(const Estimate& retry, const Prediction& prediction) const {
  if (!retry.valid || !found_.valid) return retry.valid;
  const int inliers = count(retry.rotation_inliers);
  const int inliers_before = count(found_.rotation_inliers);
  if (2 * inliers < inliers_before) return false;
  if (inliers > 2 * inliers_before) return true;
  const Matrix6d of_both = found_.covariance + retry.covariance;
  const Matrix6d of_all = of_both + covarianceOfPrediction(prediction.dt_s);
  const auto distance2 =
      [](const Eigen::Isometry3d& T_a, const Eigen::Isometry3d& T_b, const Matrix6d& covariance) {
        Vector6d difference;
        difference << T_a.translation() - T_b.translation(),
            logRotation(T_a.linear() * T_b.linear().transpose());
        return difference.dot(covariance.ldlt().solve(difference));
      };
  return distance2(retry.T_keyframe_cur, found_.T_keyframe_cur, of_both) > kSignificant2 &&
         kHalf2 * distance2(retry.T_keyframe_cur, prediction.T_keyframe_cur, of_all) <
             distance2(found_.T_keyframe_cur, prediction.T_keyframe_cur, of_all);
}

void MotionEstimator::estimateFrom(const FeatureSet& set,
                                   const Measurements& measured,
                                   const Eigen::Isometry3d& initial,
                                   double dt_s,
                                   Estimate& estimate) {
  two_stages_.estimate(measured, set, initial, dt_s, fit_, estimate);
  estimate.covariance.setZero();
  estimate.flow_noise_px = 0.0;
  estimate.valid =
      estimate.valid && estimateCovariance(config_, measured, fit_, problem_, estimate);
}

}  // namespace rotrocc
