#include "simulation/gyroscope.h"

#include <cmath>

#include "common/to_seconds.h"
#include "rotrocc/rigid_motion.h"
#include "simulation/counter_random.h"

namespace rotrocc {
namespace {

// Figures of the ADIS16448 in the EuRoC data set's sensor.yaml.
constexpr double kRate_hz = 200.0;
constexpr double kNoiseDensity = 1.6968e-4;      // [rad/s/sqrt(Hz)], white
constexpr double kBiasWalk = 1.9393e-5;          // [rad/s^2/sqrt(Hz)]
constexpr double kBiasSigma_rps = M_PI / 180.0;  // of the bias at the start, for each axis

constexpr double kPhase = 0.4;  // of a period: the first sample after first_ns

enum Kind : std::uint64_t { kStart, kWalk, kWhite };

/// Three Gaussian numbers with a standard deviation of 1.
Eigen::Vector3d noise(std::uint64_t seed, Kind kind, std::uint64_t index) {
  const auto of = [&](std::uint64_t axis) {
    return gaussian(randomBits(seed, 0x6790, 16 * index + 4 * axis + kind));
  };
  return {of(0), of(1), of(2)};
}

Eigen::Vector3d trueRate(const Drive& drive, double time_s) {
  constexpr double kStep_s = 1e-3;
  const Eigen::Matrix3d before = drive.pose(time_s - kStep_s).linear();
  const Eigen::Matrix3d after = drive.pose(time_s + kStep_s).linear();
  return logRotation(before.transpose() * after) / (2.0 * kStep_s);
}

}  // namespace

std::vector<GyroSample> simulateGyroscope(const Drive& drive,
                                          std::int64_t first_ns,
                                          std::int64_t last_ns,
                                          std::uint64_t seed) {
  const double period_s = 1.0 / kRate_hz;
  Eigen::Vector3d bias_rps = kBiasSigma_rps * noise(seed, kStart, 0);
  std::vector<GyroSample> samples;
  for (std::uint64_t i = 0; samples.empty() || samples.back().stamp_ns <= last_ns; ++i) {
    const double since_first_s = (static_cast<double>(i) - 1.0 + kPhase) * period_s;
    const std::int64_t stamp_ns = first_ns + std::llround(1e9 * since_first_s);
    samples.push_back({stamp_ns,
                       trueRate(drive, toSeconds(stamp_ns)) + bias_rps +
                           kNoiseDensity * std::sqrt(kRate_hz) * noise(seed, kWhite, i)});
    bias_rps += kBiasWalk * std::sqrt(period_s) * noise(seed, kWalk, i);
  }
  return samples;
}

}  // namespace rotrocc
