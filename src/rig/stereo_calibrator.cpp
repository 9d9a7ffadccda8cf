#include "rig/stereo_calibrator.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/image_grid.h"
#include "motion/outlier_rejection.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Number of parameters of motion and bias.
constexpr int kParameters = 7;

/// With fewer features, the bias can hardly be distinguished from the motion.
constexpr int kLeastFeatures = 30;

/// Firm shrinkage (Gao and Bruce 1997): 0 up to `doubt_px`, the full value above twice that, linear
/// in between.
double shrink(double found_px, double doubt_px) {
  const double beyond_px = std::max(0.0, std::abs(found_px) - doubt_px);
  return std::copysign(std::min(2.0 * beyond_px, std::abs(found_px)), found_px);
}

template <class Values>
double sum(const Values& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

StereoCalibrator::StereoCalibrator(const Config& config) : config_(config) {
  update();
}

void StereoCalibrator::configure(const Config& config) {
  config_ = config;
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
                               const Eigen::Isometry3d& T_keyframe_cur) {
  if (!config_.enabled) return;
  current_ = {};
  motion_by_bias_.setZero();
  if (count(set) >= kLeastFeatures) {
    linearise(corrected, features, set, T_keyframe_cur);
    eliminateMotion();
    collect();
  }
  update();
}

/// Computes the residuals and their derivatives by the motion and the bias.
void StereoCalibrator::linearise(const StereoCamera& corrected,
                                 const Correspondences& features,
                                 const FeatureSet& set,
                                 const Eigen::Isometry3d& T_keyframe_cur) {
  fitAt({corrected, features, config_.noise_ratio}, T_keyframe_cur, fit_);
  problem_.assign(corrected, fit_, set);
  problem_.weigh(problem_.start(), config_.robust_factor);
  const ImageGrid grid(corrected, kColumns, kRows);
  rows_.clear();
  problem_.linearise(problem_.start(), [&](const ReprojectionProblem<6>::Term& term) {
    rows_.push_back({grid.cell(features[term.feature].cur_px),
                     term.weight,
                     term.residual_px,
                     -term.fitted.whitening * term.fitted.by_disparity,
                     term.jacobian});
  });
}

/// Removes from residuals and derivatives the part that a change of the motion can explain. The
/// derivative of a sum of weighted residuals contains the squared weights, see MotionCovariance.
void StereoCalibrator::eliminateMotion() {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d of_bias = Vector6d::Zero();
  Vector6d of_residuals = Vector6d::Zero();
  for (const Row& row : rows_) {
    const double weight2 = row.weight * row.weight;
    normal += weight2 * row.by_motion.transpose() * row.by_motion;
    of_bias += weight2 * row.by_motion.transpose() * row.by_bias;
    of_residuals += row.weight * row.by_motion.transpose() * row.residual_px;
  }
  const Eigen::LDLT<Matrix6d> solver(normal);
  of_bias = solver.solve(of_bias.eval());
  of_residuals = solver.solve(of_residuals.eval());
  motion_by_bias_ << -of_bias.tail<3>(), -of_bias.head<3>();
  for (Row& row : rows_) {
    row.by_bias -= row.by_motion * of_bias;
    row.residual_px -= row.by_motion * of_residuals;
  }
}

/// One step of Newton's method from the applied bias. A step of reweighted least squares would be
/// too short.
void StereoCalibrator::collect() {
  WeightedVariance variance;
  bool is_finite = true;
  for (const Row& row : rows_) {
    variance.add(row.weight, row.residual_px.squaredNorm());
    is_finite = is_finite && row.by_bias.allFinite();
  }
  const double variance_px2 = variance.value(kParameters);
  if (!(variance_px2 > 0.0) || !is_finite) return;
  for (const Row& row : rows_) {
    const double information = row.weight * row.weight * row.by_bias.squaredNorm() / variance_px2;
    current_.information[row.cell] += information;
    current_.weighted[row.cell] += information * bias_.applied_px -
                                   row.weight * row.by_bias.dot(row.residual_px) / variance_px2;
  }
}

Matrix6d StereoCalibrator::motionCovariance() const {
  const double left_px = bias_.estimated_px - bias_.applied_px;
  const double variance = bias_.sigma_px * bias_.sigma_px + left_px * left_px;
  return variance * motion_by_bias_ * motion_by_bias_.transpose();
}

/// Earlier evidence is reduced in proportion to the new information. A pair at standstill has no
/// information, so it does not reduce the evidence.
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
  motion_by_bias_.setZero();
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
