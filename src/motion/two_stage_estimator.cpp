#include "motion/two_stage_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "motion/feature_errors.h"
#include "motion/motion_solver.h"

namespace rotrocc {
namespace {

/// Errors of this many standard deviations of the flow pass stage 2 even if the flow is small.
constexpr double kPassingSigmas = 2.0;

/// Features with a smaller error after stage 1, in details of the images, enter stage 2.
constexpr double kCandidate_px = 1.5;

/// The error of a feature that must not become an inlier.
constexpr double kExcludedError = std::numeric_limits<double>::infinity();

}  // namespace

void TwoStageEstimator::estimate(const Measurements& measured,
                                 const FeatureSet& set,
                                 const Eigen::Isometry3d& initial,
                                 ReprojectionProblem& problem,
                                 MotionEstimate& motion) {
  const double limit_px = measured.camera.detail_px * kRotationLimit;
  problem.assign(measured, initial);
  motion.rotation_inliers = set;
  motion.has_translation_stage = false;
  motion.translation_failed = false;
  const auto measure = [&] { problem.errors(errors_); };
  motion.valid =
      iterate(Unknowns::kMotion, limit_px, measure, problem, motion.rotation_inliers);  // 1)
  motion.translation_inliers = motion.rotation_inliers;
  motion.T_keyframe_cur = problem.motion();
  if (!motion.valid) return;
  decouple(measured, problem, motion.rotation_inliers);  // 2)
  motion.has_translation_stage =
      estimateTranslation(measured, problem, motion.translation_inliers) &&  // 3)
      count(motion.translation_inliers) >= kMinInliers;
  if (motion.has_translation_stage) {
    motion.T_keyframe_cur = problem.motion();
    return;
  }
  motion.translation_failed = true;
  motion.translation_inliers = motion.rotation_inliers;
  problem.setMotion(motion.T_keyframe_cur);
}

/// Computes the flow by which the DNRE is normalized (Eq. 27, 28), and selects the features that
/// may enter stage 2. Where the limit is less than the noise, it would select by chance: a part for
/// the noise is added.
void TwoStageEstimator::decouple(const Measurements& measured,
                                 const ReprojectionProblem& problem,
                                 const FeatureSet& inliers) {
  decoupledFlow(measured, problem.motion(), flow_px_);
  problem.errors(errors_);
  candidates_.assign(errors_.size(), 1);
  keepBelow(errors_, measured.camera.detail_px * kCandidate_px, candidates_);
  select(errors_, inliers, set_errors_);
  const double passes_px = kPassingSigmas * deviationOf(set_errors_);
  for (double& flow_px : flow_px_) {
    flow_px = std::hypot(flow_px, passes_px / kTranslationLimit);
  }
}

bool TwoStageEstimator::estimateTranslation(const Measurements& measured,
                                            ReprojectionProblem& problem,
                                            FeatureSet& inliers) {
  const auto measure = [&] {
    normalizedErrors(measured, problem.motion(), flow_px_, errors_);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      if (candidates_[i] == 0) errors_[i] = kExcludedError;
    }
  };
  inliers = candidates_;
  return iterate(Unknowns::kTranslation, kTranslationLimit, measure, problem, inliers);  // Eq. 29
}

/// Alternates between solving for the motion of the set and thresholding the errors of all
/// features, until the set is stable (Eq. 26, 30); then refines it. Returns false if there is no
/// solution.
template <class Measure>
bool TwoStageEstimator::iterate(Unknowns unknowns,
                                double limit,
                                const Measure& measure,
                                ReprojectionProblem& problem,
                                FeatureSet& set) {
  for (int i = 0; i < kMaxSelections; ++i) {
    if (!solve(unknowns, set, problem)) return false;
    measure();
    select(errors_, set, set_errors_);
    if (!keepBelow(errors_, fixedLimit(limit, kDropShare, set_errors_), set)) break;
  }
  return refine(unknowns, set, problem);
}

}  // namespace rotrocc
