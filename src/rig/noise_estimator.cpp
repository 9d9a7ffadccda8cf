#include "rig/noise_estimator.h"

#include <algorithm>
#include <cmath>

#include "geometry/image_grid.h"
#include "geometry/min_depth.h"

namespace rotrocc {
namespace {

constexpr int kColumns = 12;
constexpr int kRows = 4;

/// Fewer in a cell tell little of what they have in common.
constexpr int kLeastInCell = 4;

/// The lowest ratio believed: disparities are measured as flows are, by two pixels' comparison.
constexpr double kLeastRatio = 0.5;

/// A projection that moves less with the disparity says nothing of it: |j|^2.
constexpr double kLeastSlope2 = 1e-6;

/// The information in the ratio to begin with, as if it had been found to within itself.
double priorInformation(double ratio) {
  return 1.0 / (ratio * ratio * ratio * ratio);
}

}  // namespace

NoiseEstimator::NoiseEstimator(const Config& config, double ratio)
    : config_(config), first_ratio_(ratio), cells_(kColumns * kRows) {
  reset();
}

void NoiseEstimator::configure(const Config& config, double ratio) {
  const bool begins_anew = ratio != first_ratio_ || !config.enabled;
  config_ = config;
  first_ratio_ = ratio;
  if (begins_anew) reset();
}

void NoiseEstimator::reset() {
  noise_ = {};
  noise_.ratio = first_ratio_;
  features_ = 0.0;
  across_px2_ = 0.0;
  ratio_information_ = 0.0;
  ratio_weighted_ = 0.0;
}

void NoiseEstimator::observe(const StereoCamera& camera,
                             const Correspondences& features,
                             const FeatureSet& set,
                             const Eigen::Isometry3d& T_prev_cur) {
  collect(camera, features, set, T_prev_cur);
  update();
}

void NoiseEstimator::collect(const StereoCamera& camera,
                             const Correspondences& features,
                             const FeatureSet& set,
                             const Eigen::Isometry3d& T_prev_cur) {
  const ImageGrid grid(camera, kColumns, kRows);
  const double r2 = noise_.ratio * noise_.ratio;
  fitAt({camera, features, noise_.ratio}, T_prev_cur, fit_);
  residuals_.clear();
  std::fill(cells_.begin(), cells_.end(), Cell());
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] == 0) continue;
    const FittedFeature& fitted = fit_.features[i];
    const Eigen::Vector3d point = fitted.rotated_point + T_prev_cur.translation();
    const double j2 = fitted.by_disparity.squaredNorm();
    if (point.z() < kMinDepth_m || j2 < kLeastSlope2) continue;

    const double j = std::sqrt(j2);
    const Eigen::Vector2d direction = fitted.by_disparity / j;
    const Eigen::Vector2d error_px = fitted.target_px - camera.project(point);
    const double along_px = direction.dot(error_px);
    const double across_px = direction.x() * error_px.y() - direction.y() * error_px.x();
    residuals_.push_back({grid.cell(features[i].cur_px), j2, along_px, across_px});

    Cell& cell = cells_[residuals_.back().cell];
    const double weight = 1.0 / (1.0 + r2 * j2);
    ++cell.features;
    cell.information += weight * j2;
    cell.along_px += weight * j * along_px;
    cell.across_px += across_px;
  }
  for (Cell& cell : cells_) {
    if (cell.features < kLeastInCell) continue;
    cell.along_px /= cell.information;
    cell.across_px /= cell.features;
  }
}

void NoiseEstimator::update() {
  const double r2 = noise_.ratio * noise_.ratio;
  int used = 0;
  double across_px2 = 0.0;
  double score_px2 = 0.0;
  double information = 0.0;
  for (const Residual& residual : residuals_) {
    const Cell& cell = cells_[residual.cell];
    if (cell.features < kLeastInCell) continue;
    const double freedom = (cell.features - 1.0) / cell.features;
    const double along_px = residual.along_px - std::sqrt(residual.j2) * cell.along_px;
    const double across = residual.across_px - cell.across_px;
    const double whitening = 1.0 / (1.0 + r2 * residual.j2);
    const double slope = residual.j2 * whitening;
    ++used;
    across_px2 += across * across / freedom;
    score_px2 += slope * (whitening * along_px * along_px - across * across) / freedom;
    information += slope * slope;
  }
  if (used == 0) return;

  const double kept = 1.0 - 1.0 / config_.memory_pairs;
  features_ = kept * features_ + used;
  across_px2_ = kept * across_px2_ + across_px2;
  const double variance_px2 = across_px2_ / features_;
  if (!(variance_px2 > 0.0)) return;
  noise_.flow_px = std::sqrt(variance_px2);
  if (config_.enabled && first_ratio_ > 0.0) {
    // Two squares of Gaussian errors, each of twice the squared variance, are compared.
    ratio_information_ = kept * ratio_information_ + 0.25 * information;
    ratio_weighted_ = kept * ratio_weighted_ + 0.25 * (r2 * information + score_px2 / variance_px2);
    const double prior = priorInformation(first_ratio_);
    const double found =
        (ratio_weighted_ + prior * first_ratio_ * first_ratio_) / (ratio_information_ + prior);
    noise_.ratio = std::clamp(std::sqrt(std::max(found, 0.0)), kLeastRatio, config_.max_ratio);
  }
  noise_.disparity_px = noise_.ratio * noise_.flow_px;
}

}  // namespace rotrocc
