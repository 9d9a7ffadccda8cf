#include "motion/shared_error_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motion/feature_errors.h"
#include "motion/reprojection_problem.h"

namespace rotrocc {
namespace {

/// The start counts as much as this many pairs without noise. A usual one has a weight
/// of a third.
constexpr double kPriorPairs = 1.0;

/// The weight of what was seen falls by a factor e over this many pairs without noise.
constexpr double kMemoryPairs = 15.0;

/// Smallest square of the ratio that weights are computed for: that of disparities as exact as
/// flows.
constexpr double kLeastRatio2 = 1.0;

/// Number of parameters of a motion, which was fitted to the same features.
constexpr int kParameters = 6;

}  // namespace

double SharedErrorEstimator::ratio() const {
  const double scatter = kPriorPairs * kStart * kStart + past_.scatter + last_.scatter;
  const double mean = scatter / (kPriorPairs + past_.weight + last_.weight);
  return std::clamp(std::sqrt(std::max(0.0, mean)), 0.0, kMostGrowth * kStart);
}

void SharedErrorEstimator::advance() {
  const double kept = std::exp(-last_.weight / kMemoryPairs);
  past_.scatter = kept * past_.scatter + last_.scatter;
  past_.weight = kept * past_.weight + last_.weight;
  last_ = {};
}

void SharedErrorEstimator::observe(const StereoCamera& camera,
                                   const Correspondences& features,
                                   const FeatureSet& set,
                                   const Eigen::Isometry3d& T_keyframe_cur) {
  fitAt({camera, features, kDisparityNoiseRatio}, T_keyframe_cur, fit_);
  problem_.assign(camera, fit_, set);
  problem_.weigh(problem_.start(), kCauchyFactor);
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
  if (!(variance_px2 > 0.0)) return;
  const double assumed = std::max(ratio() * ratio(), kLeastRatio2);
  Moments pair;
  int count = 0;
  for (const Cell& cell : cells) {
    if (!(cell.information > 0.0)) continue;
    ++count;
    const double error_px = cell.weighted_px / cell.information;
    const double noise = 1.0 / cell.information;
    const double weight = 1.0 / ((noise + assumed) * (noise + assumed));
    pair.scatter += weight * (error_px * error_px / variance_px2 - noise);
    pair.weight += weight;
  }
  if (count <= kParameters) return;
  // In units of the weight of as many cells without noise.
  const double most = count / (assumed * assumed);
  const double by_motion = static_cast<double>(count - kParameters) / count;  // it was fitted
  pair = {pair.scatter / most, by_motion * pair.weight / most};
  if (pair.weight > 0.0 && std::isfinite(pair.scatter)) last_ = pair;
}

}  // namespace rotrocc
