#include "odometry/motion_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/concatenate.h"
#include "motion/median_depth.h"
#include "motion/outlier_rejection.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Changes within this many standard deviations are attributed to noise.
constexpr double kSigmas = 3.0;
/// A keyframe serves another pair if it has this many times min_inliers.
constexpr int kReserve = 2;
/// Share of the median depth. A shorter step changes the image little: its uncertainty is compared
/// with the scene, or it would have none small enough at standstill.
constexpr double kShortStep = 0.02;

// Limits beyond which a motion is degraded. None depends on the size of the image.

/// Share of the keyframe's corners that have a disparity. Those of dirty lenses or misaligned
/// cameras are few, and chosen by chance.
constexpr double kMinWithDepth = 0.15;
/// Share of the feature set that are inliers of the rotation stage. In a short step, features at
/// rest on the image (of dirt, or of its compression) agree on a standstill.
constexpr double kMinByRotation = 0.7;
/// The same for a motion without a prediction, which nothing else confirms.
constexpr double kMinAtStart = 0.8;
/// Share of the feature set that are inliers of the translation stage. Those of far points with
/// inexact disparities are missing, also if the motion is right.
constexpr double kMinByTranslation = 0.5;
/// Share of the feature set that agrees on another motion.
constexpr double kMaxCompetitors = 0.2;
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

/// The share of kMaxCompetitors that is enough for features behind the others.
constexpr double kShareBehind = 0.5;
/// Noise of the flow in any image of a camera. Only what is drawn, or left by compression, is more
/// exact, and stands still when the camera moves.
constexpr double kMinNoise_px = 0.005;
/// A smaller share of inliers is not all features but some mismatches.
constexpr double kUnanimousShare = 0.95;

/// The smaller number of inliers of the two stages: both parts of the motion need enough of them.
int inliers(const MotionEstimator::Estimate& estimate) {
  return std::min(count(estimate.rotation_inliers), count(estimate.translation_inliers));
}

double shareOf(const FeatureSet& inliers) {
  return static_cast<double>(count(inliers)) / static_cast<double>(inliers.size());
}

double inlierShare(const MotionEstimator::Estimate& estimate) {
  return std::min(shareOf(estimate.rotation_inliers), shareOf(estimate.translation_inliers));
}

}  // namespace

std::string MotionCheck::checkNotLost(const MotionEstimator::Estimate& estimate,
                                      const Eigen::Isometry3d& T_keyframe_last,
                                      double dt_s) const {
  const auto features = static_cast<int>(estimate.rotation_inliers.size());
  if (features < config_.min_inliers) {
    return concatenate("only ",
                       features,
                       " features were matched, fewer than min_inliers = ",
                       config_.min_inliers);
  }
  if (!estimate.valid) return "the features determine no motion";
  if (inliers(estimate) < config_.min_inliers) {
    return concatenate("only ",
                       inliers(estimate),
                       " features agree on a motion, fewer than min_inliers = ",
                       config_.min_inliers);
  }
  if (inlierShare(estimate) < config_.min_inlier_share) {
    return concatenate("only a share of ",
                       inlierShare(estimate),
                       " of the features agrees on a motion, less than min_inlier_share = ",
                       config_.min_inlier_share);
  }
  const Eigen::Isometry3d T_last_cur = T_keyframe_last.inverse() * estimate.T_keyframe_cur;
  const double speed_mps = T_last_cur.translation().norm() / dt_s;
  if (speed_mps > config_.max_speed_mps) {
    return concatenate("the estimated speed is ",
                       speed_mps,
                       " m/s, more than max_speed_mps = ",
                       config_.max_speed_mps);
  }
  const double turn_rate_rps = logRotation(T_last_cur.linear()).norm() / dt_s;
  if (turn_rate_rps > config_.max_turn_rate_rps) {
    return concatenate("the estimated turn rate is ",
                       turn_rate_rps,
                       " rad/s, more than max_turn_rate_rps = ",
                       config_.max_turn_rate_rps);
  }
  return "";
}

std::string MotionCheck::whyDegraded(const Hypothesis& accepted, const Matrix6d& covariance) {
  const MotionEstimator::Estimate& estimate = accepted.estimate;
  if (estimate.translation_failed && isLarge(estimate.rotation_inliers)) {
    return concatenate("the translation stage has fewer than min_inliers = ",
                       config_.min_inliers,
                       " inliers: the motion is that of the rotation stage");
  }
  std::string why = whyFewHaveDepth(accepted.counts);
  if (why.empty()) why = whyFewAgree(estimate, accepted.has_prediction);
  if (why.empty()) why = whyFewSurvive(accepted);
  if (why.empty()) why = whyAmbiguous(accepted);
  if (why.empty()) why = whyFewDetermine(accepted);
  return why.empty() ? whyUndetermined(accepted, covariance) : why;
}

/// Whether fewer than min_inliers inliers mean that the features disagree. In a small set, they may
/// agree and be too few for the translation stage; the motion of the rotation stage is then as
/// good.
bool MotionCheck::isLarge(const FeatureSet& features) const {
  return config_.min_inliers < kMinByTranslation * static_cast<double>(features.size());
}

std::string MotionCheck::whyFewHaveDepth(const StageCounts& counts) const {
  if (counts.with_depth >= kMinWithDepth * counts.corners) return "";
  return concatenate("only ",
                     counts.with_depth,
                     " of ",
                     counts.corners,
                     " corners have a disparity, a share below ",
                     kMinWithDepth,
                     "; are the lenses clean, and left and right rows aligned?");
}

std::string MotionCheck::whyFewAgree(const MotionEstimator::Estimate& estimate,
                                     bool has_prediction) const {
  const double by_rotation = shareOf(estimate.rotation_inliers);
  if (by_rotation < kMinByRotation) {
    return concatenate("a share of ",
                       by_rotation,
                       " of the features agrees on the motion, less than ",
                       kMinByRotation);
  }
  if (!has_prediction && by_rotation < kMinAtStart) {
    return concatenate("without a prediction, a share of ",
                       by_rotation,
                       " of the features agrees on the motion, less than ",
                       kMinAtStart);
  }
  if (!has_prediction && by_rotation < kUnanimousShare && estimate.flow_noise_px < kMinNoise_px) {
    return concatenate(
        "without a prediction, a share of ",
        by_rotation,
        " of the features agrees on the motion, more exactly (",
        estimate.flow_noise_px,
        " px) than features of the scene: something drawn or compressed stands still");
  }
  const double by_translation = shareOf(estimate.translation_inliers);
  if (by_translation >= kMinByTranslation) return "";
  return concatenate("a share of ",
                     by_translation,
                     " of the features agrees on the translation, less than ",
                     kMinByTranslation);
}

std::string MotionCheck::whyFewSurvive(const Hypothesis& accepted) const {
  const int survivors = inliers(accepted.estimate);
  const int features = accepted.counts.with_depth;
  if (survivors >= kMinSurvivors * features) return "";
  return concatenate("the motion rests on ",
                     survivors,
                     " of ",
                     features,
                     " features, a share below ",
                     kMinSurvivors);
}

/// Whether many features agree on another motion. Then it may be that of an object that fills the
/// image. Fewer are enough if they are behind the inliers, as what an object hides.
std::string MotionCheck::whyAmbiguous(const Hypothesis& accepted) {
  const auto features = static_cast<double>(accepted.features.size());
  const double many = kMaxCompetitors * features;
  const int min_count =
      std::max(config_.min_inliers, static_cast<int>(std::ceil(kShareBehind * many)));
  const CompetingMotion::Competitors competitors =
      competing_motion_.find(accepted.camera,
                             accepted.features,
                             accepted.estimate.T_keyframe_cur,
                             accepted.estimate.rotation_inliers,
                             min_count);
  if (competitors.count == 0 || (!competitors.are_behind && competitors.count < many)) return "";
  return concatenate("another motion fits ",
                     competitors.count,
                     " of the ",
                     features,
                     competitors.are_behind
                         ? " features, which are behind the others, a share above half of "
                         : " features, a share above ",
                     kMaxCompetitors,
                     ": one of the two is that of a large object");
}

/// Whether few inliers determine the motion, and other features contradict them. It may be that of
/// a wrong match then.
std::string MotionCheck::whyFewDetermine(const Hypothesis& accepted) {
  const double share =
      information_share_.minimum({accepted.camera, accepted.features, noise_ratio_},
                                 accepted.estimate.T_keyframe_cur,
                                 accepted.estimate.translation_inliers);
  if (share >= kMinInformation) return "";
  return concatenate("the inliers but one have a share of ",
                     share,
                     " of the information about a part of the motion, less than ",
                     kMinInformation,
                     ": few features determine it");
}

std::string MotionCheck::whyUndetermined(const Hypothesis& accepted, const Matrix6d& covariance) {
  const MotionEstimator::Estimate& estimate = accepted.estimate;
  const double depth_m = medianDepth(accepted.features, estimate.rotation_inliers, depths_m_);
  const double step_m =
      std::max(estimate.T_keyframe_cur.translation().norm(), kShortStep * depth_m);
  const double sigma_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  if (sigma_m <= kMaxSigma * step_m) return "";
  return concatenate("the translation has a standard deviation of ",
                     sigma_m,
                     " m, more than a share of ",
                     kMaxSigma,
                     " of ",
                     step_m,
                     " m");
}

bool MotionCheck::hasReserve(const MotionEstimator::Estimate& accepted) const {
  return inliers(accepted) >= kReserve * config_.min_inliers;
}

std::string MotionCheck::whyJump(const UncertainTransform& motion,
                                 const Eigen::Isometry3d& expected,
                                 double dt_s) const {
  const double change_m = (motion.T.translation() - expected.translation()).norm();
  const double variance_m2 = motion.covariance.topLeftCorner<3, 3>().trace();
  const double beyond_noise_m = change_m - kSigmas * std::sqrt(variance_m2);
  const double acceleration_mps2 = beyond_noise_m / (dt_s * dt_s);
  if (acceleration_mps2 <= config_.max_acceleration_mps2) return "";
  return concatenate("the velocity changed by ",
                     acceleration_mps2,
                     " m/s2, more than max_acceleration_mps2 = ",
                     config_.max_acceleration_mps2);
}

}  // namespace rotrocc
