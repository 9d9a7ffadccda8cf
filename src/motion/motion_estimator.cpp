#include "motion/motion_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "motion/flow_decoupling.h"
#include "motion/reprojection_error.h"

namespace rotrocc {
namespace {

/// Keeps a normalized error finite where there is no flow at all [px].
constexpr double kLeastFlow_px = 1e-6;

/// Of the fits with robust weights, each by the errors that the one before has left.
constexpr int kReweightings = 4;

/// The error of a feature that must not enter.
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Errors that are Gaussian in x and y, of which only those shorter than `limit_px` are left with
/// the variance `left_px2` in each direction: the share of the whole variance that this is. It is
/// g = 1 - x / (e^x - 1) with x = limit^2 / (2 variance).
double shareOfVariance(double left_px2, double limit_px) {
  const auto g = [](double x) { return 1.0 - x / std::expm1(x); };
  // Nearly even errors up to the limit say little of the variance: no less than one is assumed that
  // makes the covariance 20 times as large.
  double low = 0.5;
  double high = 50.0;
  const double wanted = 2.0 * left_px2 / (limit_px * limit_px);  // g(x) / x, which falls
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (g(middle) / middle > wanted ? low : high) = middle;
  }
  return g(low);
}

/// How much larger the covariance is than that of independent errors, by the variance per degree of
/// freedom that the scatter of the cells shows and that of a residual: neighbours share texture, an
/// object's motion and what is left of the lens.
double inflation(double scatter_px2, double residual_px2) {
  return residual_px2 > 0.0 ? std::max(1.0, scatter_px2 / residual_px2) : 1.0;
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

OutlierThreshold rotationThreshold(Criterion criterion, const MotionEstimator::Config& config) {
  switch (criterion) {
    case Criterion::kMeanBased:
      return OutlierThreshold::meanBased(config.mean_factor);
    case Criterion::kStdBased:
      return OutlierThreshold::deviationBased(config.deviation_factor);
    default:
      return OutlierThreshold::fixedLimit(config.rotation_limit_px, config.rotation_drop_share);
  }
}

}  // namespace

const std::vector<std::string>& criterionNames() {
  static const std::vector<std::string> names = {
      "rotrocc", "reprojection", "rocc", "mean_based", "std_based"};
  return names;
}

MotionEstimator::MotionEstimator(const Config& config)
    : config_(config),
      criterion_(criterionOf(config.criterion)),
      solver_(config.noise_ratio, config.robust_factor),
      rotation_threshold_(rotationThreshold(criterion_, config)),
      translation_threshold_(
          OutlierThreshold::fixedLimit(config.translation_limit, config.translation_drop_share)) {}

void MotionEstimator::setNoiseRatio(double noise_ratio) {
  config_.noise_ratio = noise_ratio;
  solver_.setNoiseRatio(noise_ratio);
}

const MotionEstimator::Estimate& MotionEstimator::estimate(const StereoCamera& camera,
                                                           const Correspondences& features,
                                                           const Eigen::Isometry3d& initial,
                                                           double dt_s,
                                                           bool is_prediction) {
  solver_.setFeatures(camera, features);
  all_.assign(features.size(), 1);
  estimateFrom(all_, camera, features, initial, dt_s, found_);
  const int agree = found_.valid ? count(found_.rotation_inliers) : 0;
  const bool doubtful = agree < config_.retry_share * static_cast<double>(features.size());
  if (!doubtful || !is_prediction || config_.retry_agreement_px == 0.0) return found_;

  solver_.measureErrors(initial, errors_);
  near_ = all_;
  keepBelow(errors_, config_.retry_agreement_px, near_);
  estimateFrom(near_, camera, features, initial, dt_s, other_);
  const auto deviation = [&](const Estimate& estimate) {
    return (estimate.T_prev_cur.translation() - initial.translation()).norm();
  };
  const bool likelier = other_.valid && 2 * count(other_.rotation_inliers) >= agree &&
                        (!found_.valid || deviation(other_) < deviation(found_));
  return likelier ? other_ : found_;
}

void MotionEstimator::estimateFrom(const FeatureSet& set,
                                   const StereoCamera& camera,
                                   const Correspondences& features,
                                   const Eigen::Isometry3d& initial,
                                   double dt_s,
                                   Estimate& estimate) {
  estimate.T_prev_cur = initial;
  estimate.covariance.setZero();
  estimate.has_translation_stage = false;
  estimate.rotation_inliers = set;
  estimate.valid = estimateRotation(estimate);
  estimate.translation_inliers = estimate.rotation_inliers;

  const bool two_stages = criterion_ == Criterion::kRotrocc || criterion_ == Criterion::kRocc;
  const bool slow = estimate.T_prev_cur.translation().norm() < config_.min_speed_mps * dt_s;
  if (estimate.valid && two_stages && !slow) {
    estimate.has_translation_stage = true;
    estimate.valid = estimateTranslation(camera, features, estimate);
  }
  estimate.valid = estimate.valid && estimateCovariance(estimate);
}

bool MotionEstimator::estimateRotation(Estimate& estimate) {
  Eigen::Isometry3d& T = estimate.T_prev_cur;
  const auto fit = [&](const FeatureSet& set, Weights weights) {
    return solver_.solveMotion(set, weights, T);  // Eq. 25
  };
  const auto measure = [&] { solver_.measureErrors(T, errors_); };
  const bool compared = criterion_ == Criterion::kMeanBased || criterion_ == Criterion::kStdBased;
  const int iterations = compared ? config_.comparison_iterations : config_.rotation_max_iterations;
  return iterate(rotation_threshold_, iterations, fit, measure, estimate.rotation_inliers);
}

bool MotionEstimator::estimateTranslation(const StereoCamera& camera,
                                          const Correspondences& features,
                                          Estimate& estimate) {
  Eigen::Isometry3d& T = estimate.T_prev_cur;
  if (criterion_ == Criterion::kRotrocc) {
    decoupledFlow(camera, features, T.linear(), flow_px_);  // Eq. 27, 28
  } else {
    coupledFlow(features, flow_px_);
  }

  solver_.measureErrors(T, errors_);
  candidates_.assign(features.size(), 1);
  if (config_.translation_initial_px > 0.0) {
    keepBelow(errors_, config_.translation_initial_px, candidates_);
  }

  const auto fit = [&](const FeatureSet& set, Weights weights) {
    return solver_.solveTranslation(set, weights, T);  // Eq. 29
  };
  // Plain errors: only then is the DNRE the relative error of the depth, and wrong disparities of
  // far points, which differ from the right one by a large part of it, are seen.
  const auto measure = [&] {
    reprojectionErrors(camera, features, T, errors_);
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      const double flow_px = std::max({flow_px_[i], config_.min_flow_px, kLeastFlow_px});
      errors_[i] = candidates_[i] != 0 ? errors_[i] / flow_px : kNever;
    }
  };
  estimate.translation_inliers = candidates_;
  return iterate(translation_threshold_,
                 config_.translation_max_iterations,
                 fit,
                 measure,
                 estimate.translation_inliers);
}

template <class Fit, class Measure>
bool MotionEstimator::iterate(OutlierThreshold& threshold,
                              int max_iterations,
                              const Fit& fit,
                              const Measure& measure,
                              FeatureSet& set) {
  next_ = set;
  for (int i = 0; i < max_iterations; ++i) {
    if (!fit(set, Weights::kEqual)) return false;
    measure();
    if (!keepBelow(errors_, threshold(errors_, set), next_)) break;
    set = next_;
  }
  // At least once more, with the disparities fitted where the last one ended.
  if (config_.robust_factor == 0.0) return fit(set, Weights::kEqual);
  for (int i = 0; i < kReweightings; ++i) {
    if (!fit(set, Weights::kRobust)) return false;
  }
  return true;
}

/// The rotation's covariance comes from stage 1 with its translation marginalized; the
/// translation's from stage 2, plus what the rotation's error dR does to it:
/// dt = -(Jt^T Jt)^-1 Jt^T Jr dR.
///
/// Features beyond the limit of stage 1 are dropped, though some are just noisy: what is left has
/// only a share g of the errors' variance, and a fit to it the variance of one to untruncated
/// errors over g (the sandwich formula, where both its parts are g).
bool MotionEstimator::estimateCovariance(Estimate& estimate) {
  const auto one = solver_.information(estimate.rotation_inliers, estimate.T_prev_cur, 6);
  const Eigen::LDLT<Matrix6d> full(one.matrix);
  if (full.info() != Eigen::Success || !full.isPositive()) return false;
  const bool truncated = criterion_ != Criterion::kMeanBased && criterion_ != Criterion::kStdBased;
  const double share =
      truncated ? shareOfVariance(one.residual_variance, config_.rotation_limit_px) : 1.0;
  const double variance = one.residual_variance / share;
  const double alike = inflation(full.solve(one.scatter).trace() / 6.0, one.residual_variance);
  const Matrix6d both = alike * variance / share * full.solve(Matrix6d::Identity());
  if (!both.allFinite()) return false;
  estimate.covariance = both;
  if (!estimate.has_translation_stage) return true;

  const auto two = solver_.information(estimate.translation_inliers, estimate.T_prev_cur, 3);
  const Eigen::LDLT<Eigen::Matrix3d> translation(two.matrix.topLeftCorner<3, 3>());
  if (translation.info() != Eigen::Success || !translation.isPositive()) return false;
  const Eigen::Matrix3d by_rotation = -translation.solve(two.matrix.topRightCorner<3, 3>());
  const Eigen::Matrix3d rotation = both.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d scatter = two.scatter.topLeftCorner<3, 3>();
  const double alike_two =
      inflation(translation.solve(scatter).trace() / 3.0, two.residual_variance);
  estimate.covariance.topLeftCorner<3, 3>() = alike_two *
                                                  std::max(two.residual_variance, variance) *
                                                  translation.solve(Eigen::Matrix3d::Identity()) +
                                              by_rotation * rotation * by_rotation.transpose();
  estimate.covariance.topRightCorner<3, 3>() = by_rotation * rotation;
  estimate.covariance.bottomLeftCorner<3, 3>() = rotation * by_rotation.transpose();
  return estimate.covariance.allFinite();
}

}  // namespace rotrocc
