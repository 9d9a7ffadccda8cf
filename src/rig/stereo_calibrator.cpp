#include "rig/stereo_calibrator.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/image_grid.h"
#include "motion/outlier_rejection.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Of motion and bias.
constexpr int kParameters = 7;

/// Fewer features tell a bias from a motion badly.
constexpr int kLeastFeatures = 30;

/// Nothing of what is within the doubt, all of what is beyond twice the doubt, and straight between
/// (firm shrinkage, Gao and Bruce 1997).
double shrink(double found_px, double doubt_px) {
  const double beyond_px = std::max(0.0, std::abs(found_px) - doubt_px);
  return std::copysign(std::min(2.0 * beyond_px, std::abs(found_px)), found_px);
}

template <class Values>
double sum(const Values& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

StereoCalibrator::StereoCalibrator(const Config& config)
    : config_(config), weights_(config.robust_factor) {
  update();
}

void StereoCalibrator::configure(const Config& config) {
  config_ = config;
  weights_ = CauchyWeights(config.robust_factor);
  if (config_.enabled) {
    update();
  } else {
    reset();
  }
}

StereoCamera StereoCalibrator::correct(const StereoCamera& camera) const {
  StereoCamera corrected = camera;
  corrected.cx_right += bias_.applied_px;
  return corrected;
}

void StereoCalibrator::observe(const StereoCamera& corrected,
                               const Correspondences& features,
                               const FeatureSet& set,
                               const Eigen::Isometry3d& T_prev_cur) {
  if (!config_.enabled) return;
  current_ = {};
  motion_by_bias_.setZero();
  if (count(set) >= kLeastFeatures) {
    linearise(corrected, features, set, T_prev_cur);
    eliminateMotion();
    collect(corrected, features, set);
  }
  update();
}

/// Residuals and their derivatives by the motion and the bias, all times the roots of the weights.
void StereoCalibrator::linearise(const StereoCamera& corrected,
                                 const Correspondences& features,
                                 const FeatureSet& set,
                                 const Eigen::Isometry3d& T_prev_cur) {
  problem_.assign(corrected, features, set, T_prev_cur, config_.noise_ratio);
  Vector6d parameters;
  parameters << Eigen::Vector3d::Zero(), T_prev_cur.translation();
  problem_.weigh(parameters, weights_);
  const auto rows = static_cast<std::size_t>(problem_.residualCount());
  residuals_.resize(rows);
  by_motion_.resize(6 * rows);
  by_bias_.resize(rows);
  problem_.linearise(parameters, residuals_.data(), by_motion_.data());

  Column by_bias = byBias();
  Eigen::Index row = 0;
  for (const FittedFeature& feature : problem_.features()) {
    by_bias.segment<2>(row) = -feature.whitening * feature.by_disparity;
    row += 2;
  }
}

/// Leaves of residuals and derivative what no change of the motion can explain. The weighted sums
/// of residuals follow their changes by the square of the weight, see MotionSolver::Information.
void StereoCalibrator::eliminateMotion() {
  const Columns by_motion = byMotion();
  Matrix6d normal = Matrix6d::Zero();
  Vector6d of_bias = Vector6d::Zero();
  for (Eigen::Index row = 0; row < by_motion.rows(); row += 2) {
    const auto J = by_motion.middleRows<2>(row);
    const double weight = weights_[static_cast<std::size_t>(row / 2)];
    normal += weight * J.transpose() * J;
    of_bias += weight * J.transpose() * byBias().segment<2>(row);
  }
  const Eigen::LDLT<Matrix6d> solver(normal);
  of_bias = solver.solve(of_bias.eval());
  const Vector6d of_residuals = solver.solve(by_motion.transpose() * residuals());
  motion_by_bias_ << -of_bias.tail<3>(), -of_bias.head<3>();
  byBias().noalias() -= by_motion * of_bias;
  residuals().noalias() -= by_motion * of_residuals;
}

/// A step of Newton's method from the bias applied: one of reweighted least squares would be too
/// short.
void StereoCalibrator::collect(const StereoCamera& corrected,
                               const Correspondences& features,
                               const FeatureSet& set) {
  const Column errors = residuals();
  const Column slopes = byBias();
  const double variance = weights_.variance(errors, kParameters);
  if (!(variance > 0.0) || !slopes.allFinite()) return;
  const ImageGrid grid(corrected, kColumns, kRows);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] == 0) continue;
    const std::size_t cell = grid.cell(features[i].cur_px);
    const auto slope = slopes.segment<2>(row);
    const double weight = weights_[static_cast<std::size_t>(row / 2)];
    const double information = weight * slope.squaredNorm() / variance;
    current_.information[cell] += information;
    current_.weighted[cell] +=
        information * bias_.applied_px - slope.dot(errors.segment<2>(row)) / variance;
    row += 2;
  }
}

Matrix6d StereoCalibrator::motionCovariance() const {
  const double left_px = bias_.estimated_px - bias_.applied_px;
  const double variance = bias_.sigma_px * bias_.sigma_px + left_px * left_px;
  return variance * motion_by_bias_ * motion_by_bias_.transpose();
}

/// What is known fades as more is learnt: a pair at rest, which tells nothing, takes nothing.
void StereoCalibrator::advance() {
  const double known = sum(past_.information);
  const double learnt = sum(current_.information) * config_.memory_pairs;
  const double kept = 1.0 - (learnt < known ? learnt / known : 1.0) / config_.memory_pairs;
  for (std::size_t cell = 0; cell < past_.information.size(); ++cell) {
    past_.information[cell] = kept * past_.information[cell] + current_.information[cell];
    past_.weighted[cell] = kept * past_.weighted[cell] + current_.weighted[cell];
  }
  current_ = {};
}

void StereoCalibrator::reset() {
  past_ = {};
  current_ = {};
  update();
}

void StereoCalibrator::update() {
  double information = 0.0;
  double weighted = 0.0;
  for (std::size_t cell = 0; cell < past_.information.size(); ++cell) {
    information += past_.information[cell] + current_.information[cell];
    weighted += past_.weighted[cell] + current_.weighted[cell];
  }
  const double measured_px = information > 0.0 ? weighted / information : 0.0;
  double disagreement = 0.0;
  for (std::size_t cell = 0; cell < past_.information.size(); ++cell) {
    const double score = past_.weighted[cell] + current_.weighted[cell] -
                         (past_.information[cell] + current_.information[cell]) * measured_px;
    disagreement += score * score;
  }
  if (disagreement > information) information *= information / disagreement;

  const double prior = 1.0 / (config_.prior_sigma_px * config_.prior_sigma_px);
  const double shared = config_.matching_sigma_px * config_.matching_sigma_px;
  bias_.sigma_px = std::sqrt(1.0 / (information + prior) + shared);
  const double found_px = information * (measured_px - config_.bias_px) / (information + prior);
  bias_.estimated_px = config_.bias_px + found_px;
  bias_.applied_px = config_.bias_px + shrink(found_px, config_.significance * bias_.sigma_px);
}

}  // namespace rotrocc
