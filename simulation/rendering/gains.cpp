#include "simulation/rendering/gains.h"

#include <array>
#include <cmath>

#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

constexpr double kTurn_rad = 2.0 * M_PI;

/// Around `mean`, with an amplitude and a period from these ranges.
GainSwing randomSwing(RandomStream& random,
                      double mean,
                      const std::array<double, 2>& amplitude,
                      const std::array<double, 2>& period_s) {
  const double swing = mean * random.uniform(amplitude[0], amplitude[1]);
  return {mean - swing,
          mean + swing,
          random.uniform(period_s[0], period_s[1]),
          random.uniform(0.0, kTurn_rad)};
}

}  // namespace

double GainSwing::at(double time_s) const {
  const double share = 0.5 + 0.5 * std::sin(kTurn_rad * time_s / period_s + phase_rad);
  return low + (high - low) * share;
}

double Gains::at(double time_s, bool of_right) const {
  return common.at(time_s) * (of_right ? right : left).at(time_s);
}

Gains driftingGains(std::uint64_t seed) {
  RandomStream random(seed, 0x6A1);
  const auto own = [&] {
    const double mean = random.uniform(0.94, 1.06);
    return randomSwing(random, mean, {0.01, 0.04}, {5.0, 15.0});
  };
  Gains gains;
  gains.common = randomSwing(random, 1.0, {0.05, 0.15}, {6.0, 20.0});
  gains.left = own();
  gains.right = own();
  return gains;
}

Gains outOfStepGains(std::uint64_t seed) {
  RandomStream random(seed, 0x6A2);
  Gains gains;
  gains.left = {0.5, 1.0, random.uniform(3.0, 5.0), random.uniform(0.0, kTurn_rad)};
  gains.right = gains.left;
  gains.right.phase_rad += random.uniform(0.25 * kTurn_rad, 0.5 * kTurn_rad);
  return gains;
}

}  // namespace rotrocc
