#include "motion/two_stage_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "motion/feature_errors.h"

namespace rotrocc {
namespace {

/// Limit of the DNRE in stage 2 (Eq. 30).
constexpr double kTranslationLimit = 0.04;

/// Errors of this many standard deviations of the flow pass stage 2 even if the flow is small.
constexpr double kPassingSigmas = 2.0;

/// Features with a smaller error after stage 1, in details of the images, enter stage 2.
constexpr double kCandidate_px = 1.5;

/// Stage 2 as published is skipped below this speed: without parallax, it only adds noise.
constexpr double kMinSpeed_mps = 1.0;

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

double rotationThreshold(Criterion criterion, double detail_px, std::vector<double>& errors_px) {
  switch (criterion) {
    case Criterion::kMeanBased:
      return meanBasedLimit(kMeanFactor, errors_px);
    case Criterion::kStdBased:
      return deviationBasedLimit(kDeviationFactor, errors_px);
    default:
      return fixedLimit(detail_px * kRotationLimit, kDropShare, errors_px);
  }
}

}  // namespace

const std::vector<std::string>& criterionNames() {
  static const std::vector<std::string> names = {
      "rotrocc", "reprojection", "rocc", "mean_based", "std_based"};
  return names;
}

Criterion criterionOf(const std::string& name) {
  const auto& names = criterionNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument(
        "criterion is \"" + name +
        "\", but must be rotrocc, reprojection, rocc, mean_based or std_based");
  }
  return static_cast<Criterion>(found - names.begin());
}

TwoStageEstimator::TwoStageEstimator(const MotionEstimatorConfig& config)
    : config_(config), criterion_(criterionOf(config.criterion)) {}

void TwoStageEstimator::estimate(const Measurements& measured,
                                 const FeatureSet& set,
                                 const Eigen::Isometry3d& initial,
                                 double dt_s,
                                 ReprojectionProblem& problem,
                                 MotionEstimate& motion) {
  problem.assign(measured, initial);
  motion.rotation_inliers = set;
  motion.has_translation_stage = false;
  motion.translation_failed = false;
  motion.valid =
      estimateRotation(measured.camera.detail_px, problem, motion.rotation_inliers);  // 1)
  motion.translation_inliers = motion.rotation_inliers;
  motion.T_keyframe_cur = problem.motion();

  const bool has_two_stages = criterion_ == Criterion::kRotrocc || criterion_ == Criterion::kRocc;
  const bool is_slow =
      config_.as_published && problem.motion().translation().norm() < kMinSpeed_mps * dt_s;
  if (!motion.valid || !has_two_stages || is_slow) return;
  decouple(measured, problem, motion.rotation_inliers);  // 2)
  selectCandidates(measured, problem);
  if (config_.as_published) {
    Eigen::Isometry3d T_start = motion.T_keyframe_cur;
    T_start.translation() = initial.translation();
    problem.setMotion(T_start);
  }
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

bool TwoStageEstimator::estimateRotation(double detail_px,
                                         ReprojectionProblem& problem,
                                         FeatureSet& inliers) {
  const auto measure = [&] { problem.errors(errors_); };
  const auto threshold = [&](std::vector<double>& errors_px) {
    return rotationThreshold(criterion_, detail_px, errors_px);
  };
  const int iterations = hasFixedLimit(criterion_) ? kMaxIterations : kComparisonIterations;
  return iterate(iterations, Unknowns::kMotion, problem, measure, threshold, inliers);  // Eq. 25
}

/// Computes the flow by which the DNRE (or NRE) is normalized. Where the limit is less than the
/// noise, it would select by chance: a part for the noise is added.
void TwoStageEstimator::decouple(const Measurements& measured,
                                 const ReprojectionProblem& problem,
                                 const FeatureSet& inliers) {
  if (criterion_ == Criterion::kRotrocc) {
    decoupledFlow(measured.camera,
                  measured.features,
                  problem.motion().linear(),
                  flow_px_);  // Eq. 27, 28
  } else {
    coupledFlow(measured.features, flow_px_);
  }
  if (config_.as_published) return;
  problem.errors(errors_);
  select(errors_, inliers, set_errors_);
  const double passes_px = kPassingSigmas * deviationOf(set_errors_);
  for (double& flow_px : flow_px_) {
    flow_px = std::hypot(flow_px, passes_px / kTranslationLimit);
  }
}

/// Selects the features that may enter stage 2.
void TwoStageEstimator::selectCandidates(const Measurements& measured,
                                         const ReprojectionProblem& problem) {
  candidates_.assign(measured.features.size(), 1);
  if (config_.as_published) return;
  problem.errors(errors_);
  keepBelow(errors_, measured.camera.detail_px * kCandidate_px, candidates_);
}

bool TwoStageEstimator::estimateTranslation(const Measurements& measured,
                                            ReprojectionProblem& problem,
                                            FeatureSet& inliers) {
  // Errors without whitening. Only then does the DNRE equal the relative depth error, which is
  // large for far points with a wrong disparity.
  const auto measure = [&] {
    reprojectionErrors(measured.camera, measured.features, problem.motion(), errors_);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      const double flow_px = std::max(flow_px_[i], kMinFlow_px);
      errors_[i] = candidates_[i] != 0 ? errors_[i] / flow_px : kExcludedError;
    }
  };
  const auto threshold = [&](std::vector<double>& errors) {
    return fixedLimit(kTranslationLimit, kDropShare, errors);
  };
  inliers = candidates_;
  return iterate(
      kMaxIterations, Unknowns::kTranslation, problem, measure, threshold, inliers);  // Eq. 29
}

/// Alternates between solving for the motion of the set and thresholding the errors of all
/// features, until the set is stable (Eq. 26, 30, 31, 32); then refines it, but not as published.
/// Returns false if there is no solution.
template <class Measure, class Threshold>
bool TwoStageEstimator::iterate(int max_iterations,
                                Unknowns unknowns,
                                ReprojectionProblem& problem,
                                const Measure& measure,
                                const Threshold& threshold,
                                FeatureSet& set) {
  next_ = set;
  for (int i = 0; i < max_iterations; ++i) {
    if (!solve(unknowns, set, problem)) return false;
    measure();
    select(errors_, set, set_errors_);
    if (!keepBelow(errors_, threshold(set_errors_), next_)) break;
    set = next_;
  }
  return config_.as_published || refine(unknowns, set, problem);
}

}  // namespace rotrocc
