#include "odometry/motion_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <opencv2/core.hpp>

#include "common/compared_text.h"
#include "common/median.h"
#include "motion/feature_errors.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Changes within this many standard deviations are attributed to noise.
constexpr double kSigmas = 3.0;
/// A smaller share of inliers of the feature set is no motion of the camera.
constexpr double kMinShare = 0.15;
/// The camera rests while the median flow is below this many times its noise.
constexpr double kRest = 6.0;
/// Share of the median depth. A shorter step changes the image little: its uncertainty is compared
/// with the scene, or it would have none small enough at standstill.
constexpr double kShortStep = 0.02;

// Limits beyond which a motion is degraded. None depends on the size of the image.

/// Share of the feature set that are inliers of the rotation stage. In a short step, features at
/// rest on the image (of dirt, or of its compression) agree on a standstill.
constexpr double kMinByRotation = 0.7;
/// The same for a motion without a prediction, which nothing else confirms.
constexpr double kMinAtStart = 0.8;
/// Share of the features tracked in the left image that the right one shows, too. It is 0.5 to
/// 0.95 on real clips, as little as 0.1 if left and right are of different times.
constexpr double kMinPaired = 0.5;
/// Share of the feature set that are inliers of the translation stage. Those of far points with
/// inexact disparities are missing, also if the motion is right.
constexpr double kMinByTranslation = 0.5;
/// Share of the keyframe's features with a depth that are inliers. After a wrong prediction, up to
/// a tenth of the features match somewhere by chance.
constexpr double kMinSurvivors = 0.1;
/// Share of the information about each part of the motion that inliers of the translation stage
/// have without the most informative one. If nearly all features are far away, few near ones
/// determine the translation, and those that are wrong may agree by chance.
constexpr double kMinInformation = 0.15;
/// Standard deviation of the translation, relative to its length since the keyframe, or to 2 % of
/// the median depth if that is more.
constexpr double kMaxSigma = 0.05;

/// Largest usual change of velocity per second [m/s^2]: that of drones.
constexpr double kMaxAcceleration_mps2 = 30.0;

/// The smallest eigenvalue of part v = lambda whole v.
double leastShare(const Matrix6d& part, const Matrix6d& whole) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> shares(
      part, whole, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
  return shares.info() == Eigen::Success ? std::clamp(shares.eigenvalues()[0], 0.0, 1.0) : 0.0;
}

/// The smaller number of inliers of the two stages: both parts of the motion need enough of them.
int inliers(const MotionEstimate& estimate) {
  return std::min(count(estimate.rotation_inliers), count(estimate.translation_inliers));
}

double shareOf(const FeatureSet& inliers) {
  return static_cast<double>(count(inliers)) / static_cast<double>(inliers.size());
}

std::string fewAgree(double share, const char* on_what, double limit) {
  return "a fraction of " + comparedText(share, limit) + " of the features agrees on the " +
         on_what + cv::format(", less than %g", limit);
}

}  // namespace

std::optional<std::string> MotionCheck::whyLost(const Hypothesis& found,
                                                const Eigen::Isometry3d& T_keyframe_last,
                                                double dt_s) const {
  const MotionEstimate& estimate = found.estimate;
  const auto features = static_cast<int>(estimate.rotation_inliers.size());
  if (features < kMinInliers) {
    return cv::format("only %d features were matched, fewer than %d", features, kMinInliers);
  }
  if (!estimate.valid) return "the features do not determine a motion";
  const int agreeing = inliers(estimate);
  if (agreeing < kMinInliers) {
    return cv::format("only %d features agree on a motion, fewer than %d", agreeing, kMinInliers);
  }
  double share = shareOf(estimate.rotation_inliers);
  // As published, stage 2 has few inliers where disparities are biased.
  if (!as_published_) share = std::min(share, shareOf(estimate.translation_inliers));
  if (share < kMinShare) return "only " + fewAgree(share, "motion", kMinShare);
  const Eigen::Isometry3d T_last_cur = T_keyframe_last.inverse() * estimate.T_keyframe_cur;
  const double speed_mps = T_last_cur.translation().norm() / dt_s;
  if (speed_mps > config_.max_speed_mps) {
    return "the estimated speed is " + comparedText(speed_mps, config_.max_speed_mps) +
           cv::format(" m/s, more than max_speed_mps = %g", config_.max_speed_mps);
  }
  const double turn_rate_rps = logRotation(T_last_cur.linear()).norm() / dt_s;
  if (turn_rate_rps > config_.max_turn_rate_rps) {
    return "the estimated turn rate is " + comparedText(turn_rate_rps, config_.max_turn_rate_rps) +
           cv::format(" rad/s, more than max_turn_rate_rps = %g", config_.max_turn_rate_rps);
  }
  const int by_rotation = found.counts.rotation_inliers;
  if (as_published_ || 2 * by_rotation >= features ||
      by_rotation >= kMinSurvivors * found.counts.with_depth) {
    return std::nullopt;
  }
  return cv::format("only %d of %d tracked features agree on a motion", by_rotation, features) +
         cv::format(", of %d in all: that many may agree by chance", found.counts.with_depth);
}

std::optional<std::string> MotionCheck::whyNotAtRest(const Hypothesis& accepted) {
  const StageCounts& counts = accepted.counts;
  const double share = static_cast<double>(counts.rotation_inliers) / counts.with_depth;
  if (as_published_ || share >= kMinByRotation || !isAtRest(accepted)) return std::nullopt;
  return "the camera seems stationary, but only a fraction of " +
         comparedText(share, kMinByRotation) +
         cv::format(" of the keyframe's features is found again, less than %g", kMinByRotation);
}

std::optional<std::string> MotionCheck::whyFewAgree(const Hypothesis& accepted) {
  if (const auto why = whyNotAtRest(accepted)) return why;
  const StageCounts& counts = accepted.counts;
  if (!as_published_ && counts.consistent < kMinPaired * counts.tracked) {
    return cv::format(
               "the right image shows %d of the %d features", counts.consistent, counts.tracked) +
           cv::format(" tracked in the left one, a fraction of less than %g", kMinPaired);
  }
  const MotionEstimate& estimate = accepted.estimate;
  const bool has_prediction = accepted.has_prediction;
  const double by_rotation = shareOf(estimate.rotation_inliers);
  if (by_rotation < kMinByRotation) return fewAgree(by_rotation, "motion", kMinByRotation);
  if (!has_prediction && by_rotation < kMinAtStart) {
    return "without a prediction, " + fewAgree(by_rotation, "motion", kMinAtStart);
  }
  const double by_translation = shareOf(estimate.translation_inliers);
  if (by_translation >= kMinByTranslation) return std::nullopt;
  return fewAgree(by_translation, "translation", kMinByTranslation);
}

std::optional<std::string> MotionCheck::whyDegraded(const Hypothesis& accepted,
                                                    const Matrix6d& covariance) {
  const MotionEstimate& estimate = accepted.estimate;
  // Few inliers of a small set may agree and be too few for the translation stage; the motion of
  // the rotation stage is then as good.
  const double half = kMinByTranslation * static_cast<double>(estimate.rotation_inliers.size());
  if (estimate.translation_failed && kMinInliers < half) {
    return cv::format("the translation stage has fewer than %d inliers: ", kMinInliers) +
           "the motion of the rotation stage is used";
  }
  std::optional<std::string> why = whyFewAgree(accepted);
  if (!why) why = whyFewDetermine(accepted);
  return why ? why : whyUndetermined(accepted, covariance);
}

/// Whether few inliers determine the motion, and other features contradict them. It may be that of
/// a wrong match then.
std::optional<std::string> MotionCheck::whyFewDetermine(const Hypothesis& accepted) {
  const double share = informationShare(accepted);
  if (share >= kMinInformation) return std::nullopt;
  return "without one of them, the inliers hold a fraction of " +
         comparedText(share, kMinInformation) +
         cv::format(" of the information on part of the motion, below %g", kMinInformation) +
         ": few features determine it";
}

/// The smallest share, over all directions of the six-dimensional motion, of the Fisher information
/// of all features that the inliers have, without the inlier of greatest leverage. In [0, 1]; 0 if
/// these features do not determine the motion.
///
/// If it is small, the motion depends on one feature, or other features contradict those that
/// determine it. The inliers fit it nevertheless, and their residuals are as small as usual.
double MotionCheck::informationShare(const Hypothesis& accepted) {
  const double noise_ratio = as_published_ ? 0.0 : kDisparityNoiseRatio;
  const Eigen::Isometry3d& T_keyframe_cur = accepted.estimate.T_keyframe_cur;
  problem_.assign({accepted.camera, accepted.features, noise_ratio}, T_keyframe_cur);
  const auto informationAt = [&]() -> Matrix6d {
    constexpr int kMotion = LinearBlock::kMotion;
    return problem_.normalMatrix(T_keyframe_cur, kMotion).block<6, 6>(kMotion, kMotion);
  };
  const Matrix6d of_all = informationAt();
  problem_.select(accepted.estimate.translation_inliers);
  const Matrix6d of_inliers = informationAt();
  const Eigen::LLT<Matrix6d> determined(of_inliers);
  if (determined.info() != Eigen::Success) return 0.0;
  const Matrix6d covariance = determined.solve(Matrix6d::Identity());
  double max_leverage = 0.0;
  Eigen::Matrix<double, 2, 6> of_most = Eigen::Matrix<double, 2, 6>::Zero();
  problem_.visit(T_keyframe_cur, [&](const ReprojectionProblem::Term& term) {
    const double leverage = (term.jacobian * covariance).cwiseProduct(term.jacobian).sum();
    if (leverage <= max_leverage) return;
    max_leverage = leverage;
    of_most = term.jacobian;
  });
  return leastShare(of_inliers - of_most.transpose() * of_most, of_all);
}

std::optional<std::string> MotionCheck::whyUndetermined(const Hypothesis& accepted,
                                                        const Matrix6d& covariance) {
  const MotionEstimate& estimate = accepted.estimate;
  depths_m_.clear();
  for (std::size_t i = 0; i < accepted.features.size(); ++i) {
    if (estimate.rotation_inliers[i] != 0) {
      depths_m_.push_back(accepted.features[i].point_cur.z());
    }
  }
  const double step_m =
      std::max(estimate.T_keyframe_cur.translation().norm(), kShortStep * median(depths_m_));
  const double sigma_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  if (sigma_m <= kMaxSigma * step_m) return std::nullopt;
  return "the translation has a standard deviation of " +
         comparedText(sigma_m, kMaxSigma * step_m) +
         cv::format(" m, more than %g times %.3g m", kMaxSigma, step_m);
}

double MotionCheck::inflation(const MotionEstimate& accepted, double common_share) {
  const auto features = static_cast<int>(accepted.rotation_inliers.size());
  const int majority = 2 * count(accepted.rotation_inliers) - features;
  const double contradicted = static_cast<double>(features) / std::max(majority, kMinInliers);
  return contradicted * (1.0 + common_share * inliers(accepted));
}

bool MotionCheck::isAtRest(const Hypothesis& accepted) {
  const MotionEstimate& estimate = accepted.estimate;
  return medianFlow_px(accepted.features, estimate.rotation_inliers) <=
         kRest * estimate.flow_noise_px;
}

std::optional<std::string> MotionCheck::whyJump(const UncertainTransform& motion,
                                                const Eigen::Isometry3d& expected,
                                                double dt_s) {
  const double change_m = (motion.T.translation() - expected.translation()).norm();
  const double variance_m2 = motion.covariance.topLeftCorner<3, 3>().trace();
  const double beyond_noise_m = change_m - kSigmas * std::sqrt(variance_m2);
  const double acceleration_mps2 = beyond_noise_m / (dt_s * dt_s);
  if (acceleration_mps2 <= kMaxAcceleration_mps2) return std::nullopt;
  return "the velocity changed by " + comparedText(acceleration_mps2, kMaxAcceleration_mps2) +
         cv::format(" m/s2, more than %g", kMaxAcceleration_mps2);
}

}  // namespace rotrocc
