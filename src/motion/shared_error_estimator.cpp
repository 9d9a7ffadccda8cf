#include "motion/shared_error_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motion/cauchy_weights.h"
#include "motion/shared_error.h"

namespace rotrocc {
namespace {

/// The configured ratio counts as much as this many pairs.
constexpr double kPriorPairs = 3.0;

/// The weight of a pair falls by a factor e over this many pairs.
constexpr double kMemoryPairs = 50.0;

/// Number of parameters of a motion, which was fitted to the same features.
constexpr int kParameters = 6;

}  // namespace

void SharedErrorEstimator::configure(const MotionEstimatorConfig& config) {
  if (config.shared_ratio == 0.0) reset();
  config_ = config;
}

double SharedErrorEstimator::ratio() const {
  if (!(pairs_.weight > 0.0)) return config_.shared_ratio;
  return std::sqrt(std::max(0.0, pairs_.scatter / pairs_.weight));
}

void SharedErrorEstimator::observe(const StereoCamera& camera,
                                   const Correspondences& features,
                                   const FeatureSet& set,
                                   const Eigen::Isometry3d& T_keyframe_cur) {
  if (config_.shared_ratio == 0.0) return;
  fitAt({camera, features, config_.noise_ratio}, T_keyframe_cur, fit_);
  problem_.assign(camera, fit_, set);
  problem_.weigh(problem_.start(), config_.robust_factor);
  const Moments pair = momentsOf();
  if (!(pair.weight > 0.0) || !std::isfinite(pair.scatter)) return;
  if (pairs_.weight == 0.0) {
    pairs_.weight = kPriorPairs * pair.weight;
    pairs_.scatter = pairs_.weight * config_.shared_ratio * config_.shared_ratio;
  }
  const double kept = 1.0 - 1.0 / kMemoryPairs;
  pairs_.scatter = kept * (pairs_.scatter + pair.scatter);
  pairs_.weight = kept * (pairs_.weight + pair.weight);
}

SharedErrorEstimator::Moments SharedErrorEstimator::momentsOf() {
  struct Cell {
    double information = 0.0;
    double weighted_px = 0.0;
  };
  std::array<Cell, SharedErrorGrid::kCells> cells;
  WeightedVariance variance;
  problem_.visitResiduals(problem_.start(), [&](const ReprojectionProblem<6>::Residual& residual) {
    const Eigen::Vector2d& by_error = residual.by_disparity;
    Cell& cell = cells[residual.cell];
    cell.information += residual.weight * by_error.squaredNorm();
    cell.weighted_px += residual.weight * by_error.dot(residual.residual_px);
    variance.add(residual.weight, residual.residual_px.squaredNorm());
  });
  const double variance_px2 = variance.value(kParameters);
  if (!(variance_px2 > 0.0)) return {};
  const double assumed = ratio() * ratio();
  Moments moments;
  int count = 0;
  for (const Cell& cell : cells) {
    if (!(cell.information > 0.0)) continue;
    ++count;
    const double error_px = cell.weighted_px / cell.information;
    const double noise = 1.0 / cell.information;
    const double weight = 1.0 / ((noise + assumed) * (noise + assumed));
    moments.scatter += weight * (error_px * error_px / variance_px2 - noise);
    moments.weight += weight;
  }
  if (count <= kParameters) return {};
  moments.weight *= static_cast<double>(count - kParameters) / count;
  return moments;
}

}  // namespace rotrocc
