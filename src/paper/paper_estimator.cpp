#include "paper/paper_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "motion/feature_errors.h"
#include "motion/motion_solver.h"

namespace rotrocc {
namespace {

/// Stage 2 is skipped below this speed: without parallax, it only adds noise.
constexpr double kMinSpeed_mps = 1.0;

/// Safety limit of the criteria without a fixed limit.
constexpr int kComparisonIterations = 10;

/// The factors of Eq. 32 and 31.
constexpr double kMeanFactor = 9.0;
constexpr double kDeviationFactor = 1.5;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

}  // namespace

const MotionEstimate& PaperEstimator::estimate(const StereoCamera& camera,
                                               const Correspondences& features,
                                               const Eigen::Isometry3d& initial,
                                               double dt_s,
                                               const std::optional<Eigen::Isometry3d>&) {
  constexpr double kPlain = 0.0;
  const Measurements measured = {camera, features, kPlain};
  const bool is_fixed = criterion_ != "mean_based" && criterion_ != "std_based";
  const double limit_px = is_fixed ? camera.detail_px * kRotationLimit : kUnlimited;
  problem_.assign(measured, initial);
  found_.rotation_inliers.assign(features.size(), 1);
  found_.has_translation_stage = found_.translation_failed = false;
  const auto measure = [&] { problem_.errors(errors_); };
  found_.valid =
      iterate(Unknowns::kMotion, limit_px, measure, found_.rotation_inliers);  // 1), Eq. 25
  found_.translation_inliers = found_.rotation_inliers;
  found_.T_keyframe_cur = problem_.motion();
  const bool has_two_stages = criterion_ == "rotrocc" || criterion_ == "rocc";
  const bool is_slow = problem_.motion().translation().norm() < kMinSpeed_mps * dt_s;
  if (found_.valid && has_two_stages && !is_slow) {
    Eigen::Isometry3d start = found_.T_keyframe_cur;
    start.translation() = initial.translation();
    problem_.setMotion(start);
    estimateTranslation(measured);  // 2) and 3)
  }
  found_.valid = estimateCovariance(measured, limit_px, kPlain, problem_, found_);
  return found_;
}

void PaperEstimator::estimateTranslation(const Measurements& measured) {
  if (criterion_ == "rotrocc") {
    decoupledFlow(measured, found_.T_keyframe_cur, flow_px_);
  } else {
    flow_px_.clear();
    for (const Correspondence& feature : measured.features) {
      flow_px_.push_back((feature.keyframe_px - feature.cur_px).norm());
    }
  }
  const auto measure = [&] { normalizedErrors(measured, problem_.motion(), flow_px_, errors_); };
  FeatureSet inliers(measured.features.size(), 1);
  found_.has_translation_stage =
      iterate(Unknowns::kTranslation, kTranslationLimit, measure, inliers) &&  // Eq. 29
      count(inliers) >= kMinInliers;
  found_.translation_failed = !found_.has_translation_stage;
  if (found_.has_translation_stage) {
    found_.translation_inliers = inliers;
    found_.T_keyframe_cur = problem_.motion();
  } else {
    problem_.setMotion(found_.T_keyframe_cur);
  }
}

/// Alternates between solving for the motion of the set and thresholding the errors of all
/// features, until the set is stable. Returns false if there is no solution.
template <class Measure>
bool PaperEstimator::iterate(Unknowns unknowns,
                             double limit,
                             const Measure& measure,
                             FeatureSet& set) {
  const int iterations = limit < kUnlimited ? kMaxSelections : kComparisonIterations;
  for (int i = 0; i < iterations; ++i) {
    if (!solve(unknowns, set, problem_)) return false;
    measure();
    select(errors_, set, set_errors_);
    if (!keepBelow(errors_, threshold(limit), set)) break;
  }
  return true;
}

/// From the errors of the set (Eq. 26, 30; without a limit 31 or 32).
double PaperEstimator::threshold(double limit) {
  if (limit < kUnlimited || set_errors_.empty()) return fixedLimit(limit, kDropShare, set_errors_);
  const auto count = static_cast<double>(set_errors_.size());
  const double mean = std::accumulate(set_errors_.begin(), set_errors_.end(), 0.0) / count;
  if (criterion_ == "mean_based") return kMeanFactor * mean;
  double squares = 0.0;
  for (const double error : set_errors_) squares += (error - mean) * (error - mean);
  return mean + kDeviationFactor * std::sqrt(squares / std::max(count - 1.0, 1.0));
}

}  // namespace rotrocc
