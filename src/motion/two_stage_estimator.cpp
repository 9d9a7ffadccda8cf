#include "motion/two_stage_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "motion/cauchy_weights.h"
#include "motion/reprojection_error.h"

namespace rotrocc {
namespace {

/// Lower limit of the flow [px], so that normalized errors stay finite without flow.
constexpr double kMinFlow_px = 1e-6;

/// The paper's b of Eq. 26 and 30: the largest share of the features that an iteration drops. With
/// a larger one, a motion that outliers have bent drops features that fit the right one.
constexpr double kDropShare = 0.15;

/// Safety limits: sets are usually stable after a few iterations.
constexpr int kMaxIterations = 30;
constexpr int kComparisonIterations = 10;  // criteria mean_based and std_based

/// The factors of Eq. 32 and 31.
constexpr double kMeanFactor = 9.0;
constexpr double kDeviationFactor = 1.5;

/// The error of a feature that must not become an inlier.
constexpr double kExcludedError = std::numeric_limits<double>::infinity();

OutlierThreshold rotationThreshold(Criterion criterion, const MotionEstimatorConfig& config) {
  switch (criterion) {
    case Criterion::kMeanBased:
      return OutlierThreshold::meanBased(kMeanFactor);
    case Criterion::kStdBased:
      return OutlierThreshold::deviationBased(kDeviationFactor);
    default:
      return OutlierThreshold::fixedLimit(config.rotation_limit_px, kDropShare);
  }
}

}  // namespace

TwoStageEstimator::TwoStageEstimator(const MotionEstimatorConfig& config)
    : config_(config),
      criterion_(criterionOf(config.criterion)),
      solver_({}),
      rotation_threshold_(rotationThreshold(criterion_, config)),
      translation_threshold_(OutlierThreshold::fixedLimit(config.translation_limit, kDropShare)) {}

void TwoStageEstimator::estimate(const Measurements& measured,
                                 const FeatureSet& set,
                                 const Eigen::Isometry3d& initial,
                                 double dt_s,
                                 int min_inliers,
                                 RobustRefinement* refinement,
                                 TwoStageMotion& motion) {
  fitAt(measured, initial, motion.fit);
  motion.rotation_inliers = set;
  motion.has_translation_stage = false;
  motion.translation_failed = false;
  motion.valid = estimateRotation(measured, refinement, motion);  // 1)
  motion.translation_inliers = motion.rotation_inliers;

  const double step_m = motion.fit.T_keyframe_cur.translation().norm();
  const bool is_slow = step_m < config_.min_speed_mps * dt_s;
  if (!motion.valid || !hasTwoStages(criterion_) || is_slow) return;
  const Eigen::Isometry3d T_stage_one = motion.fit.T_keyframe_cur;
  decouple(measured, motion);  // 2)
  selectCandidates(measured, motion.fit);
  if (config_.translation_from_prediction) {
    Eigen::Isometry3d T_start = T_stage_one;
    T_start.translation() = initial.translation();
    fitAt(measured, T_start, motion.fit);
  }
  motion.has_translation_stage = estimateTranslation(measured, refinement, motion) &&  // 3)
                                 count(motion.translation_inliers) >= min_inliers;
  if (motion.has_translation_stage) return;
  motion.translation_failed = true;
  motion.translation_inliers = motion.rotation_inliers;
  fitAt(measured, T_stage_one, motion.fit);
}

bool TwoStageEstimator::estimateRotation(const Measurements& measured,
                                         RobustRefinement* refinement,
                                         TwoStageMotion& motion) {
  Fit& fit = motion.fit;
  FeatureSet& inliers = motion.rotation_inliers;
  const auto solve = [&](const FeatureSet& set) {
    return solver_.solveMotion(measured, set, fit);  // Eq. 25
  };
  const auto measure = [&] { fittedErrors(measured.camera, fit, errors_); };
  const int iterations = hasFixedLimit(criterion_) ? kMaxIterations : kComparisonIterations;
  if (!iterate(rotation_threshold_, iterations, solve, measure, inliers)) return false;
  return refinement == nullptr || refinement->refineMotion(measured, inliers, fit);
}

/// Computes the flow by which the DNRE (or NRE) is normalized. Where the limit is less than the
/// noise, it would select by chance: a part for the noise is added.
void TwoStageEstimator::decouple(const Measurements& measured, const TwoStageMotion& stage_one) {
  if (criterion_ == Criterion::kRotrocc) {
    decoupledFlow(measured.camera,
                  measured.features,
                  stage_one.fit.T_keyframe_cur.linear(),
                  flow_px_);  // Eq. 27, 28
  } else {
    coupledFlow(measured.features, flow_px_);
  }
  if (config_.translation_noise_factor == 0.0) return;
  const double passes_px = config_.translation_noise_factor * flowNoise(measured, stage_one);
  for (double& flow_px : flow_px_) {
    flow_px = std::hypot(flow_px, passes_px / config_.translation_limit);
  }
}

/// Standard deviation of the flow [px], from the errors of stage 1.
double TwoStageEstimator::flowNoise(const Measurements& measured, const TwoStageMotion& stage_one) {
  fittedErrors(measured.camera, stage_one.fit, errors_);
  inlier_errors_px_.clear();
  for (std::size_t i = 0; i < errors_.size(); ++i) {
    if (stage_one.rotation_inliers[i] != 0) inlier_errors_px_.push_back(errors_[i]);
  }
  return deviationOf(inlier_errors_px_);
}

/// Selects the features that may enter stage 2.
void TwoStageEstimator::selectCandidates(const Measurements& measured, const Fit& fit) {
  candidates_.assign(measured.features.size(), 1);
  if (config_.translation_initial_px == 0.0) return;
  fittedErrors(measured.camera, fit, errors_);
  keepBelow(errors_, config_.translation_initial_px, candidates_);
}

bool TwoStageEstimator::estimateTranslation(const Measurements& measured,
                                            RobustRefinement* refinement,
                                            TwoStageMotion& motion) {
  Fit& fit = motion.fit;
  FeatureSet& inliers = motion.translation_inliers;
  const auto solve = [&](const FeatureSet& set) {
    return solver_.solveTranslation(measured, set, fit);  // Eq. 29
  };
  // Errors without whitening. Only then does the DNRE equal the relative depth error, which is
  // large for far points with a wrong disparity.
  const auto measure = [&] {
    reprojectionErrors(measured.camera, measured.features, fit.T_keyframe_cur, errors_);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      const double flow_px = std::max(flow_px_[i], kMinFlow_px);
      errors_[i] = candidates_[i] != 0 ? errors_[i] / flow_px : kExcludedError;
    }
  };
  inliers = candidates_;
  if (!iterate(translation_threshold_, kMaxIterations, solve, measure, inliers)) return false;
  return refinement == nullptr || refinement->refineTranslation(measured, inliers, fit);
}

/// Alternates between solving for the motion of the set and thresholding the errors of all
/// features, until the set is stable (Eq. 26, 30, 31, 32). Returns false if `solve` does.
template <class Solve, class Measure>
bool TwoStageEstimator::iterate(OutlierThreshold& threshold,
                                int max_iterations,
                                const Solve& solve,
                                const Measure& measure,
                                FeatureSet& set) {
  next_ = set;
  for (int i = 0; i < max_iterations; ++i) {
    if (!solve(set)) return false;
    measure();
    if (!keepBelow(errors_, threshold(errors_, set), next_)) break;
    set = next_;
  }
  return true;
}

}  // namespace rotrocc
