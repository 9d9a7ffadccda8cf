#include "rig/bias_filter.h"

#include <algorithm>
#include <cmath>

namespace rotrocc {
namespace {

/// Standard deviation of the change of the bias from pair to pair. The rig of Karlsruhe moves by
/// more for a part of its drive, most rigs by less.
constexpr double kWalk_px = 0.05;

/// A bias of this many standard deviations is applied by half, a smaller one hardly, a larger one
/// as a whole. Errors of lenses pass for a bias: on KITTI 04 and 06, one of 2 to 3 standard
/// deviations makes motions worse.
constexpr double kSignificance = 6.0;

/// Degrees of freedom of Student's t: about as many as the cells that decide on the bias of a pair.
constexpr double kFreedom = 6.0;

}  // namespace

/// A pair that says little about the bias, as one of a slow robot, counts as a small share of a
/// pair.
void BiasFilter::add(const BiasMeasurement& measurement) {
  const double prior_px2 = kPrior_px * kPrior_px;
  const double measured_px2 = measurement.noise_px2 + measurement.shared_px2;
  variance_px2_ += prior_px2 / (prior_px2 + measured_px2) * kWalk_px * kWalk_px;
  const double expected_px2 = variance_px2_ + measurement.noise_px2;
  const double off_px = measurement.bias_px - mean_px_;
  const double surprise =
      std::max(1.0, (kFreedom + off_px * off_px / expected_px2) / (kFreedom + 1.0));
  const double gain = variance_px2_ / (surprise * expected_px2);
  mean_px_ += gain * off_px;
  variance_px2_ *= surprise * (1.0 - gain);
  shared_px_ += gain * (std::sqrt(measurement.shared_px2) - shared_px_);
}

void BiasFilter::scale(double factor) {
  mean_px_ *= factor;
  variance_px2_ *= factor * factor;
  shared_px_ *= factor;
}

/// The probability that the bias differs from the known one is the ratio of the likelihoods of
/// both: one half at kSignificance standard deviations.
DisparityBias BiasFilter::bias() const {
  DisparityBias bias;
  const double variance_px2 = variance_px2_ + shared_px_ * shared_px_;
  const double log_odds =
      0.5 * (mean_px_ * mean_px_ / variance_px2 - kSignificance * kSignificance);
  bias.estimated_px = mean_px_;
  bias.applied_px = mean_px_ / (1.0 + std::exp(-log_odds));
  bias.sigma_px = std::sqrt(variance_px2);
  return bias;
}

}  // namespace rotrocc
