#include "rig/bias_filter.h"

#include <algorithm>
#include <cmath>

namespace rotrocc {
namespace {

/// Standard deviation of the change of the bias from pair to pair. The rig of Karlsruhe moves by
/// more for a part of its drive, most rigs by less.
constexpr double kWalk_rad = 0.05 * BiasFilter::kPrior_rad;

/// A bias of this many standard deviations is applied by half, a smaller one hardly, a larger one
/// as a whole. Errors of lenses pass for a bias: on KITTI 04 and 06, one of 2 to 3 standard
/// deviations makes motions worse.
constexpr double kSignificance = 6.0;

/// Factor of kSignificance once a bias has been applied by half: what was beyond doubt does not end
/// with a pair that is less certain.
constexpr double kHysteresis = 0.5;

/// Degrees of freedom of Student's t: about as many as the cells that decide on the bias of a pair.
constexpr double kFreedom = 6.0;

}  // namespace

/// A pair that says little about the bias, as one of a slow robot, counts as a small share of a
/// pair.
void BiasFilter::add(const BiasMeasurement& measurement, double fx_px) {
  const double noise_rad2 = measurement.noise_px2 / (fx_px * fx_px);
  const double shared_rad = std::sqrt(measurement.shared_px2) / fx_px;
  const double prior_rad2 = kPrior_rad * kPrior_rad;
  const double share = prior_rad2 / (prior_rad2 + noise_rad2 + shared_rad * shared_rad);
  variance_rad2_ += share * kWalk_rad * kWalk_rad;
  const double expected_rad2 = variance_rad2_ + noise_rad2;
  const double off_rad = measurement.bias_px / fx_px - mean_rad_;
  const double surprise =
      std::max(1.0, (kFreedom + off_rad * off_rad / expected_rad2) / (kFreedom + 1.0));
  const double gain = variance_rad2_ / (surprise * expected_rad2);
  mean_rad_ += gain * off_rad;
  variance_rad2_ *= surprise * (1.0 - gain);
  shared_rad_ += gain * (shared_rad - shared_rad_);
  is_off_ = logOdds() > 0.0;
}

/// That the bias differs from the known one: the logarithm of the ratio of the likelihoods of both,
/// zero at the significance.
double BiasFilter::logOdds() const {
  const double significance = (is_off_ ? kHysteresis : 1.0) * kSignificance;
  const double variance_rad2 = variance_rad2_ + shared_rad_ * shared_rad_;
  return 0.5 * (mean_rad_ * mean_rad_ / variance_rad2 - significance * significance);
}

DisparityBias BiasFilter::bias(double fx_px) const {
  DisparityBias bias;
  bias.estimated_px = fx_px * mean_rad_;
  bias.applied_px = bias.estimated_px / (1.0 + std::exp(-logOdds()));
  bias.sigma_px = fx_px * std::sqrt(variance_rad2_ + shared_rad_ * shared_rad_);
  return bias;
}

}  // namespace rotrocc
