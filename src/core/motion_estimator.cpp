#include "rotrocc/motion_estimator.h"

#include <algorithm>
#include <stdexcept>

#include "rotrocc/flow_decoupling.h"
#include "rotrocc/reprojection_error.h"

namespace rotrocc {
namespace {

/// Keeps a normalized error finite where there is no flow at all [px].
constexpr double kLeastFlow_px = 1e-6;

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

}  // namespace

const std::vector<std::string>& criterionNames() {
  static const std::vector<std::string> names = {
      "rotrocc", "reprojection", "rocc", "mean_based", "std_based"};
  return names;
}

MotionEstimator::MotionEstimator(const Config& config)
    : config_(config), criterion_(criterionOf(config.criterion)), solver_(config.noise_ratio) {}

MotionEstimator::Estimate MotionEstimator::estimate(const StereoCamera& camera,
                                                    const Correspondences& features,
                                                    const Eigen::Isometry3d& initial,
                                                    double dt_s) {
  Estimate estimate;
  estimate.T_prev_cur = initial;
  estimate.rotation_inliers.assign(features.size(), 1);
  estimate.valid = estimateRotation(camera, features, estimate);
  estimate.translation_inliers = estimate.rotation_inliers;

  const bool two_stages = criterion_ == Criterion::kRotrocc || criterion_ == Criterion::kRocc;
  const bool slow = estimate.T_prev_cur.translation().norm() < config_.min_speed_mps * dt_s;
  if (estimate.valid && two_stages && !slow) {
    estimate.has_translation_stage = true;
    estimate.valid = estimateTranslation(camera, features, estimate);
  }
  estimate.valid = estimate.valid && estimateCovariance(camera, features, estimate);
  return estimate;
}

bool MotionEstimator::estimateRotation(const StereoCamera& camera,
                                       const Correspondences& features,
                                       Estimate& estimate) {
  OutlierThreshold threshold =
      criterion_ == Criterion::kMeanBased ? OutlierThreshold::meanBased(config_.mean_factor)
      : criterion_ == Criterion::kStdBased
          ? OutlierThreshold::deviationBased(config_.deviation_factor)
          : OutlierThreshold::fixedLimit(config_.rotation_limit_px, config_.rotation_drop_share);
  const bool fixed_limit =
      criterion_ != Criterion::kMeanBased && criterion_ != Criterion::kStdBased;
  const int iterations =
      fixed_limit ? config_.rotation_max_iterations : config_.comparison_iterations;

  FeatureSet& set = estimate.rotation_inliers;
  FeatureSet next = set;
  for (int i = 0; i < iterations; ++i) {
    if (!solver_.solveMotion(camera, features, set, estimate.T_prev_cur)) return false;  // Eq. 25
    reprojectionErrors(camera, features, estimate.T_prev_cur, config_.noise_ratio, errors_);
    if (!keepBelow(errors_, threshold(errors_, set), next)) break;  // Eq. 26, 31, 32
    set = next;
  }
  return true;
}

bool MotionEstimator::estimateTranslation(const StereoCamera& camera,
                                          const Correspondences& features,
                                          Estimate& estimate) {
  if (criterion_ == Criterion::kRotrocc) {
    decoupledFlow(camera, features, estimate.T_prev_cur.linear(), flow_px_);  // Eq. 27, 28
  } else {
    coupledFlow(features, flow_px_);
  }

  FeatureSet& set = estimate.translation_inliers;
  reprojectionErrors(camera, features, estimate.T_prev_cur, config_.noise_ratio, errors_);
  const double initial_px = config_.translation_initial_px;
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i] = initial_px == 0.0 || errors_[i] < initial_px ? 1 : 0;
  }
  const FeatureSet candidates = set;

  auto threshold =
      OutlierThreshold::fixedLimit(config_.translation_limit, config_.translation_drop_share);
  FeatureSet next = set;
  for (int j = 0; j < config_.translation_max_iterations; ++j) {
    if (!solver_.solveTranslation(camera, features, set, estimate.T_prev_cur))
      return false;  // Eq. 29
    reprojectionErrors(camera, features, estimate.T_prev_cur, config_.noise_ratio, errors_);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      errors_[i] /= std::max({flow_px_[i], config_.min_flow_px, kLeastFlow_px});
    }
    keepBelow(errors_, threshold(errors_, set), next);  // Eq. 30
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = static_cast<char>(next[i] & candidates[i]);
    if (next == set) break;
    set = next;
  }
  return true;
}

/// The rotation's covariance comes from stage 1 with its translation marginalized; the
/// translation's from stage 2 plus what the rotation's error does to it: t(R) = t - (Jt^T Jt)^-1
/// Jt^T Jr dR.
bool MotionEstimator::estimateCovariance(const StereoCamera& camera,
                                         const Correspondences& features,
                                         Estimate& estimate) {
  const auto one =
      solver_.information(camera, features, estimate.rotation_inliers, estimate.T_prev_cur, 6);
  const Eigen::LDLT<Matrix6d> full(one.matrix);
  if (full.info() != Eigen::Success || !full.isPositive()) return false;
  const Matrix6d both = one.residual_variance * full.solve(Matrix6d::Identity());
  if (!both.allFinite()) return false;
  estimate.covariance = both;
  if (!estimate.has_translation_stage) return true;

  const auto two =
      solver_.information(camera, features, estimate.translation_inliers, estimate.T_prev_cur, 3);
  const Eigen::LDLT<Eigen::Matrix3d> translation(two.matrix.topLeftCorner<3, 3>());
  if (translation.info() != Eigen::Success || !translation.isPositive()) return false;
  const Eigen::Matrix3d by_rotation = -translation.solve(two.matrix.topRightCorner<3, 3>());
  const Eigen::Matrix3d rotation = both.bottomRightCorner<3, 3>();
  estimate.covariance.topLeftCorner<3, 3>() =
      two.residual_variance * translation.solve(Eigen::Matrix3d::Identity()) +
      by_rotation * rotation * by_rotation.transpose();
  estimate.covariance.topRightCorner<3, 3>() = by_rotation * rotation;
  estimate.covariance.bottomLeftCorner<3, 3>() = rotation * by_rotation.transpose();
  return estimate.covariance.allFinite();
}

}  // namespace rotrocc
