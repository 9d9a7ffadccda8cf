#include "paper/paper_estimator.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>

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

double meanOf(const std::vector<double>& errors) {
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

double deviationAbout(double mean, const std::vector<double>& errors) {
  double squares = 0.0;
  for (const double error : errors) squares += (error - mean) * (error - mean);
  return std::sqrt(squares / std::max(static_cast<double>(errors.size()) - 1.0, 1.0));
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

PaperEstimator::PaperEstimator(const MotionEstimatorConfig& config)
    : criterion_(criterionOf(config.criterion)) {}

const MotionEstimate& PaperEstimator::estimate(const StereoCamera& camera,
                                               const Correspondences& features,
                                               const Eigen::Isometry3d& initial,
                                               double dt_s,
                                               const std::optional<Eigen::Isometry3d>&) {
  constexpr double kPlain = 0.0;
  const Measurements measured = {camera, features, kPlain};
  const double limit_px = hasFixedLimit() ? camera.detail_px * kRotationLimit : kUnlimited;
  problem_.assign(measured, initial);
  found_.rotation_inliers.assign(features.size(), 1);
  found_.has_translation_stage = found_.translation_failed = false;
  found_.valid = estimateRotation(limit_px);  // 1)
  found_.translation_inliers = found_.rotation_inliers;
  found_.T_keyframe_cur = problem_.motion();
  const bool has_two_stages = criterion_ == Criterion::kRotrocc || criterion_ == Criterion::kRocc;
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

/// Of the reprojection error in stage 1.
bool PaperEstimator::hasFixedLimit() const {
  return criterion_ != Criterion::kMeanBased && criterion_ != Criterion::kStdBased;
}

/// From the errors of the set; infinite if it is empty.
double PaperEstimator::rotationThreshold(double limit_px) {
  if (hasFixedLimit()) return fixedLimit(limit_px, kDropShare, set_errors_);
  if (set_errors_.empty()) return kUnlimited;
  const double mean_px = meanOf(set_errors_);
  if (criterion_ == Criterion::kMeanBased) return kMeanFactor * mean_px;     // Eq. 32
  return mean_px + kDeviationFactor * deviationAbout(mean_px, set_errors_);  // Eq. 31
}

bool PaperEstimator::estimateRotation(double limit_px) {
  const auto measure = [&] { problem_.errors(errors_); };
  const auto threshold = [&] { return rotationThreshold(limit_px); };
  const int iterations = hasFixedLimit() ? kMaxSelections : kComparisonIterations;
  return iterate(
      iterations, Unknowns::kMotion, measure, threshold, found_.rotation_inliers);  // Eq. 25
}

void PaperEstimator::estimateTranslation(const Measurements& measured) {
  if (criterion_ == Criterion::kRotrocc) {
    decoupledFlow(measured, found_.T_keyframe_cur, flow_px_);
  } else {
    flow_px_.clear();
    for (const Correspondence& feature : measured.features) {
      flow_px_.push_back((feature.keyframe_px - feature.cur_px).norm());
    }
  }
  const auto measure = [&] { normalizedErrors(measured, problem_.motion(), flow_px_, errors_); };
  const auto threshold = [&] { return fixedLimit(kTranslationLimit, kDropShare, set_errors_); };
  FeatureSet inliers(measured.features.size(), 1);
  found_.has_translation_stage =
      iterate(kMaxSelections, Unknowns::kTranslation, measure, threshold, inliers) &&  // Eq. 29
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
/// features, until the set is stable (Eq. 26, 30, 31, 32). Returns false if there is no solution.
template <class Measure, class Threshold>
bool PaperEstimator::iterate(int max_iterations,
                             Unknowns unknowns,
                             const Measure& measure,
                             const Threshold& threshold,
                             FeatureSet& set) {
  for (int i = 0; i < max_iterations; ++i) {
    if (!solve(unknowns, set, problem_)) return false;
    measure();
    select(errors_, set, set_errors_);
    if (!keepBelow(errors_, threshold(), set)) break;
  }
  return true;
}

}  // namespace rotrocc
