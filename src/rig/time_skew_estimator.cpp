#include "rig/time_skew_estimator.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "motion/cauchy_weights.h"

namespace rotrocc {
namespace {

/// Each pair reduces the weight of the earlier ones by this factor.
constexpr double kKept = 0.99;

/// Features before which nothing is known: with fewer, chance matches would do.
constexpr double kLeastFeatures = 100.0;

/// Information of the prior, in units of the noise: a few pixels of offset and of velocity unit.
constexpr double kPrior = 0.01;

/// Velocities are of this order of magnitude: keeps the equations well conditioned.
constexpr double kVelocity_pxps = 100.0;

/// Vertical errors of lenses and rectification that the polynomial leaves [px]. They look like a
/// skew of up to 1.5 ms with the cameras of KITTI, which are triggered together.
constexpr double kRemainder_px = 0.05;

/// Of cauchyWeights(), for weights of 1/2 at 1.5 standard deviations: that of errors in one
/// direction is 1.746 times that which it assumes of lengths with the same median.
constexpr double kRobustFactor = 1.5 * 1.746;

}  // namespace

void TimeSkewEstimator::reset() {
  information_.setZero();
  information_.diagonal().setConstant(kPrior);
  weighted_px_.setZero();
  squares_px2_ = 0.0;
  weights_ = 0.0;
}

TimeSkewEstimator::Unknowns TimeSkewEstimator::coefficients(const StereoCamera& camera,
                                                            const Correspondence& feature,
                                                            double interval_s) {
  const double x = (feature.cur_px.x() - camera.cx) / camera.fx;
  const double y = (feature.cur_px.y() - camera.cy) / camera.fy;
  const double velocity_pxps = (feature.cur_px.y() - feature.keyframe_px.y()) / interval_s;
  Unknowns row;
  row << 1.0, x, y, x * x, x * y, y * y, velocity_pxps / kVelocity_pxps;
  return row;
}

void TimeSkewEstimator::observe(const StereoCamera& camera,
                                const Correspondences& features,
                                const RowOffsets& rows,
                                double interval_s) {
  if (!(interval_s > 0.0) || rows.features.empty()) return;
  information_ *= kKept;
  information_.diagonal().array() += (1.0 - kKept) * kPrior;
  weighted_px_ *= kKept;
  squares_px2_ *= kKept;
  weights_ *= kKept;

  const Unknowns before = information_.ldlt().solve(weighted_px_);
  rows_.clear();
  errors_px_.clear();
  for (std::size_t i = 0; i < rows.features.size(); ++i) {
    rows_.push_back(coefficients(camera, features[rows.features[i]], interval_s));
    errors_px_.push_back(std::abs(rows.offsets_px[i] - rows_.back().dot(before)));
  }
  cauchyWeights(kRobustFactor, errors_px_, robust_weights_);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double weight = robust_weights_[i];
    information_ += weight * rows_[i] * rows_[i].transpose();
    weighted_px_ += weight * rows.offsets_px[i] * rows_[i];
    squares_px2_ += weight * errors_px_[i] * errors_px_[i];
    weights_ += weight;
  }
}

TimeSkew TimeSkewEstimator::skew() const {
  TimeSkew skew;
  if (weights_ < kLeastFeatures) return skew;
  const auto solver = information_.ldlt();
  const double of_px = solver.solve(Unknowns::Unit(kSkew))[kSkew];
  const double velocity2 = information_(kSkew, kSkew) / weights_;
  const double variance =
      of_px * squares_px2_ / weights_ + kRemainder_px * kRemainder_px / velocity2;
  skew.estimated_s = solver.solve(weighted_px_)[kSkew] / kVelocity_pxps;
  skew.sigma_s = std::sqrt(variance) / kVelocity_pxps;
  return skew;
}

}  // namespace rotrocc
