#include "inertial/gyro_history.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kPeriod_ns = 5 * kMs;

/// The rotation of a hand-held camera, with a rate of up to 2 rad/s.
Eigen::Matrix3d orientation(double t) {
  return expRotation({0.0, 0.5 * std::sin(4.0 * t), 0.0}) *
         expRotation({0.1 * std::sin(9.0 * t), 0.0, 0.0});
}

Eigen::Vector3d rate(double t) {
  constexpr double kStep_s = 1e-4;
  return logRotation(orientation(t - kStep_s).transpose() * orientation(t + kStep_s)) /
         (2.0 * kStep_s);
}

/// Samples at 200 Hz of the first second.
GyroHistory measured(const Eigen::Vector3d& bias_rps = Eigen::Vector3d::Zero()) {
  GyroHistory history;
  for (std::int64_t stamp_ns = 0; stamp_ns <= 1000 * kMs; stamp_ns += kPeriod_ns) {
    EXPECT_EQ(history.add({stamp_ns, rate(1e-9 * static_cast<double>(stamp_ns)) + bias_rps}),
              std::nullopt);
  }
  return history;
}

double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return logRotation(a.transpose() * b).norm();
}

TEST(GyroHistoryTest, IntegratesTheRotationBetweenAnyTwoStamps) {
  const GyroHistory history = measured();
  for (const auto& [from_ns, to_ns] : {std::pair{0 * kMs, 1000 * kMs},
                                       std::pair{13 * kMs, 113 * kMs},
                                       std::pair{401 * kMs, 402 * kMs}}) {
    ASSERT_EQ(history.whyUnknown(from_ns, to_ns), std::nullopt);
    const Eigen::Matrix3d truth = orientation(1e-9 * static_cast<double>(from_ns)).transpose() *
                                  orientation(1e-9 * static_cast<double>(to_ns));
    // The trapezoidal rule errs by rate'' h^2 / 12: 80 rad/s^3 make 2e-4 rad in a second.
    EXPECT_LT(
        angleBetween(history.rotation(from_ns, to_ns, Eigen::Vector3d::Zero()).R_from_to, truth),
        2e-4);
  }
}

TEST(GyroHistoryTest, TakesOffTheBiasAndTellsItsInfluence) {
  const Eigen::Vector3d bias(0.02, -0.05, 0.03);
  const GyroHistory history = measured(bias);
  const GyroRotation exact = history.rotation(100 * kMs, 400 * kMs, bias);
  EXPECT_LT(angleBetween(exact.R_from_to, orientation(0.1).transpose() * orientation(0.4)), 2e-4);
  const Eigen::Vector3d more(1e-3, 2e-3, -1e-3);
  const GyroRotation other = history.rotation(100 * kMs, 400 * kMs, bias + more);
  const Eigen::Matrix3d expected = exact.R_from_to * expRotation(-exact.by_bias_s * more);
  EXPECT_LT(angleBetween(other.R_from_to, expected), 1e-6);  // of the order of (0.3 s * more)^2
}

TEST(GyroHistoryTest, AddsUpAnglesWhateverTheirAxes) {
  GyroHistory history;
  for (int i = 0; i <= 20; ++i) {
    const double rate_rps = i < 10 ? 2.0 : -2.0;
    history.add({i * kPeriod_ns, {0.0, rate_rps, 0.0}});
  }
  const GyroRotation rotation = history.rotation(0, 100 * kMs, Eigen::Vector3d::Zero());
  EXPECT_NEAR(rotation.turned_rad, 0.2, 0.01);  // the interval in which the rate changes its sign
  EXPECT_LT(angleBetween(rotation.R_from_to, Eigen::Matrix3d::Identity()), 0.01);
}

TEST(GyroHistoryTest, ReportsWhatIsMissing) {
  EXPECT_EQ(GyroHistory().whyUnknown(0, kMs), "there is no sample");
  GyroHistory history = measured();
  EXPECT_EQ(history.whyUnknown(980 * kMs, 1020 * kMs),
            "the newest sample is 0.02 s older than the image: it is late, has stopped or has "
            "another clock");
  EXPECT_EQ(history.whyUnknown(-20 * kMs, 20 * kMs),
            "the oldest sample is 0.02 s newer than the image before");
  history.add({1060 * kMs, rate(1.06)});
  EXPECT_EQ(history.whyUnknown(980 * kMs, 1010 * kMs),
            "two samples are 0.06 s apart, more than 0.05 s");
  EXPECT_EQ(history.whyUnknown(900 * kMs, 1000 * kMs), std::nullopt);
}

TEST(GyroHistoryTest, RejectsSamplesThatAreNoNumbersOrOutOfOrder) {
  GyroHistory history = measured();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(history.add({1005 * kMs, {0.0, nan, 0.0}}), "the angular velocity is not a number");
  EXPECT_EQ(history.add({1000 * kMs, {0.0, 0.0, 0.0}}),
            "the timestamp is 0 s before that of the previous sample");
  EXPECT_EQ(history.add({900 * kMs, {0.0, 0.0, 0.0}}),
            "the timestamp is 0.1 s before that of the previous sample");
  EXPECT_EQ(history.add({1005 * kMs, {0.0, 0.0, 0.0}}), std::nullopt);
}

TEST(GyroHistoryTest, RestartsWhenTimeJumpsBack) {
  GyroHistory history = measured();
  EXPECT_EQ(history.add({-500 * kMs, {0.0, 0.0, 0.0}}), std::nullopt);
  EXPECT_EQ(history.newest_ns(), -500 * kMs);
  EXPECT_EQ(history.whyUnknown(100 * kMs, 200 * kMs),
            "the newest sample is 0.7 s older than the image: it is late, has stopped or has "
            "another clock");
}

TEST(GyroHistoryTest, ForgetsOldSamples) {
  GyroHistory history;
  for (int i = 0; i < 2000; ++i) history.add({i * kPeriod_ns, {0.0, 0.0, 0.0}});
  EXPECT_NE(history.whyUnknown(4000 * kMs, 4100 * kMs), std::nullopt);
  EXPECT_EQ(history.whyUnknown(5000 * kMs, 9900 * kMs), std::nullopt);
}

}  // namespace
}  // namespace rotrocc
