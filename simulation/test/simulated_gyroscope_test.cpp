#include "simulation/gyroscope.h"

#include <cmath>

#include <gtest/gtest.h>

#include "inertial/gyro_history.h"
#include "rotrocc/rigid_motion.h"
#include "simulation/drives/scenario.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kFrame_ns = 100'000'000;
constexpr int kFrames = 100;

std::vector<GyroSample> samplesOf(const Drive& drive, std::uint64_t seed, const GyroFigures& f) {
  return simulateGyroscope(drive, 0, kFrames * kFrame_ns, seed, f);
}

/// The rotation between frames by the samples is off by this vector [rad].
Eigen::Vector3d errorBefore(int frame, const GyroHistory& history, const Drive& drive) {
  const std::int64_t to_ns = frame * kFrame_ns;
  EXPECT_EQ(history.whyUnknown(to_ns - kFrame_ns, to_ns), "");
  const GyroRotation rotation = history.rotation(to_ns - kFrame_ns, to_ns, Eigen::Vector3d::Zero());
  const double to_s = 1e-9 * static_cast<double>(to_ns);
  const Eigen::Matrix3d truth =
      drive.pose(to_s - 1e-9 * kFrame_ns).linear().transpose() * drive.pose(to_s).linear();
  return logRotation(truth.transpose() * rotation.R_from_to);
}

std::vector<Eigen::Vector3d> errors(const Drive& drive, const std::vector<GyroSample>& samples) {
  GyroHistory history;
  std::vector<Eigen::Vector3d> errors;
  for (const GyroSample& sample : samples) {
    EXPECT_EQ(history.add(sample), "");
    const int next = static_cast<int>(errors.size()) + 1;
    if (next <= kFrames && sample.stamp_ns >= next * kFrame_ns) {
      errors.push_back(errorBefore(next, history, drive));
    }
  }
  EXPECT_EQ(errors.size(), static_cast<std::size_t>(kFrames));
  return errors;
}

TEST(GyroscopeTest, WithoutErrorsItTurnsAsTheFramesDo) {
  const Scenario handheld = scenario("handheld", 1);
  GyroFigures perfect;
  perfect.noise_density = perfect.bias_walk = perfect.bias_sigma_rps = 0.0;
  for (const Eigen::Vector3d& error :
       errors(*handheld.drive, samplesOf(*handheld.drive, 1, perfect))) {
    EXPECT_LT(error.norm(), 1e-4);  // trapezoids of 5 ms, rates that turn around within 0.3 s
  }
}

TEST(GyroscopeTest, HasTheNoiseOfItsFigures) {
  const Scenario handheld = scenario("handheld", 1);
  GyroFigures noisy;
  noisy.bias_walk = noisy.bias_sigma_rps = 0.0;
  double squares = 0.0;
  for (const Eigen::Vector3d& error :
       errors(*handheld.drive, samplesOf(*handheld.drive, 1, noisy))) {
    squares += error.squaredNorm() / (3.0 * kFrames);
  }
  // White noise grows with the square root of time. 300 numbers give it to 4 %, three times that.
  const double expected_rad = noisy.noise_density * std::sqrt(1e-9 * kFrame_ns);
  EXPECT_NEAR(std::sqrt(squares), expected_rad, 0.15 * expected_rad);
}

TEST(GyroscopeTest, HasAnotherBiasForEachSeed) {
  const Scenario handheld = scenario("handheld", 1);
  const auto mean = [&](std::uint64_t seed) -> Eigen::Vector3d {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& error : errors(*handheld.drive, samplesOf(*handheld.drive, seed, {}))) {
      sum += error;
    }
    return sum / (kFrames * 1e-9 * kFrame_ns);
  };
  EXPECT_EQ(mean(1), mean(1));
  EXPECT_GT((mean(1) - mean(2)).norm(), 1e-3);
  EXPECT_LT(mean(1).norm(), 5.0 * GyroFigures().bias_sigma_rps);
}

}  // namespace
}  // namespace rotrocc
