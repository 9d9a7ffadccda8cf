#include "rig/bias_filter.h"

#include <algorithm>
#include <cmath>

namespace rotrocc {
namespace {

/// Standard deviation of the bias of rigs [px]: that of KITTI's drives is up to 1.2 px.
constexpr double kPrior_px = 1.0;

/// Mean number of pairs before a rigid rig begins to move, or the reverse. The rig of Karlsruhe
/// did so within a drive of 11 s.
constexpr double kSteadyPairs = 300.0;

/// Standard deviation of the change of the bias from pair to pair while the rig moves [px], as that
/// of Karlsruhe.
constexpr double kFlex_px = 1.0;

/// A bias of this many standard deviations is applied by half, a smaller one hardly, a larger one
/// as a whole. Errors of lenses pass for a bias: on KITTI 04 and 06, one of 2 to 3 standard
/// deviations makes motions worse.
constexpr double kSignificance = 6.0;

/// Degrees of freedom of Student's t: about as many as the cells that decide on the bias of a pair.
constexpr double kFreedom = 6.0;

}  // namespace

BiasFilter::BiasFilter() {
  const double moving = 1.0 / kSteadyPairs;
  modes_[0] = {1.0 - moving, 0.0, 0.0, kPrior_px * kPrior_px, 0.0};
  modes_[1] = {moving, kFlex_px, 0.0, kPrior_px * kPrior_px, 0.0};
}

/// A pair that says little about the bias, as one of a slow robot, counts as a small share of a
/// pair.
void BiasFilter::add(const BiasMeasurement& measurement) {
  const double prior_px2 = kPrior_px * kPrior_px;
  const double measured_px2 = measurement.noise_px2 + measurement.shared_px2;
  const double share = prior_px2 / (prior_px2 + measured_px2);
  const double changes = share / kSteadyPairs;

  modes_ = interact(changes);
  double sum = 0.0;
  std::array<double, 2> log_likelihood;
  for (std::size_t i = 0; i < 2; ++i) {
    modes_[i].variance_px2 += share * modes_[i].walk_px * modes_[i].walk_px;
    log_likelihood[i] = update(measurement, modes_[i]);
  }
  const double most = std::max(log_likelihood[0], log_likelihood[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    modes_[i].probability *= std::exp(log_likelihood[i] - most);
    sum += modes_[i].probability;
  }
  for (Mode& mode : modes_) mode.probability /= sum;
}

/// The modes before the next measurement, if each changes to the other with the given
/// probability.
BiasFilter::Modes BiasFilter::interact(double probability) const {
  Modes mixed = modes_;
  for (std::size_t i = 0; i < 2; ++i) {
    const Mode& same = modes_[i];
    const Mode& other = modes_[1 - i];
    const double changed = probability * other.probability;
    mixed[i].probability = (1.0 - probability) * same.probability + changed;
    const double share = changed / mixed[i].probability;
    const double apart_px = other.mean_px - same.mean_px;
    mixed[i].mean_px += share * apart_px;
    mixed[i].shared_px += share * (other.shared_px - same.shared_px);
    mixed[i].variance_px2 = (1.0 - share) * same.variance_px2 + share * other.variance_px2 +
                            share * (1.0 - share) * apart_px * apart_px;
  }
  return mixed;
}

/// Returns the logarithm of the likelihood, without a constant.
double BiasFilter::update(const BiasMeasurement& measurement, Mode& mode) {
  double variance_px2 = mode.variance_px2 + measurement.noise_px2;
  const double off_px = measurement.bias_px - mode.mean_px;
  const double off2 = off_px * off_px / variance_px2;
  const double log_likelihood =
      -0.5 * (std::log(variance_px2) + (kFreedom + 1.0) * std::log1p(off2 / kFreedom));
  variance_px2 *= std::max(1.0, (kFreedom + off2) / (kFreedom + 1.0));
  const double gain = mode.variance_px2 / variance_px2;
  mode.mean_px += gain * off_px;
  mode.variance_px2 -= gain * mode.variance_px2;
  mode.shared_px += gain * (std::sqrt(measurement.shared_px2) - mode.shared_px);
  return log_likelihood;
}

void BiasFilter::scale(double factor) {
  for (Mode& mode : modes_) {
    mode.mean_px *= factor;
    mode.variance_px2 *= factor * factor;
    mode.shared_px *= factor;
  }
}

/// Variance of the bias, with that by shared errors.
double BiasFilter::variance(const Mode& mode) {
  return mode.variance_px2 + mode.shared_px * mode.shared_px;
}

DisparityBias BiasFilter::bias() const {
  DisparityBias bias;
  double square_px2 = 0.0;
  for (const Mode& mode : modes_) {
    bias.estimated_px += mode.probability * mode.mean_px;
    bias.applied_px += mode.probability * probabilityOff(mode) * mode.mean_px;
    square_px2 += mode.probability * (variance(mode) + mode.mean_px * mode.mean_px);
  }
  bias.sigma_px = std::sqrt(square_px2 - bias.estimated_px * bias.estimated_px);
  return bias;
}

/// Probability that the bias differs from the known one: the ratio of the likelihoods of both. It
/// is one half at kSignificance standard deviations.
double BiasFilter::probabilityOff(const Mode& mode) {
  const double sigmas2 = mode.mean_px * mode.mean_px / variance(mode);
  const double log_odds = 0.5 * (sigmas2 - kSignificance * kSignificance);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace rotrocc
