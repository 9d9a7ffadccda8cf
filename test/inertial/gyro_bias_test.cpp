#include "inertial/gyro_bias.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kNoise_rad = 3e-4;
const Eigen::Matrix3d kByBias = kPeriod_s * Eigen::Matrix3d::Identity();
const Eigen::Matrix3d kCovariance = kNoise_rad * kNoise_rad * Eigen::Matrix3d::Identity();
const Eigen::Vector3d kTruth(0.02, -0.04, 0.08);

/// What rotations show that are measured with noise.
class Observer {
 public:
  Eigen::Vector3d difference(const GyroBias& filter) {
    const Eigen::Vector3d noise(normal_(generator_), normal_(generator_), normal_(generator_));
    return -kPeriod_s * (kTruth - filter.bias_rps()) + kNoise_rad * noise;
  }

 private:
  std::mt19937 generator_{1};
  std::normal_distribution<double> normal_;
};

double sigma(const GyroBias& filter) {
  return std::sqrt(filter.covariance().trace());
}

TEST(GyroBiasTest, FindsTheBiasWithinItsUncertainty) {
  GyroBias filter;
  Observer observer;
  double before = sigma(filter);
  for (int i = 0; i < 100; ++i) {
    filter.observe(observer.difference(filter), kByBias, kCovariance, kPeriod_s);
    EXPECT_LT(sigma(filter), before);
    before = sigma(filter);
    EXPECT_LT((filter.bias_rps() - kTruth).norm(), 4.0 * sigma(filter)) << i;
  }
  // 100 observations of 3e-4 rad in 0.1 s.
  EXPECT_LT(sigma(filter), 2.0 * std::sqrt(3.0) * kNoise_rad / kPeriod_s / 10.0);
  // A wrong rotation, as by a bus that passes, has little influence.
  const Eigen::Vector3d found = filter.bias_rps();
  filter.observe({0.0, 0.1, 0.0}, kByBias, kCovariance, kPeriod_s);
  EXPECT_LT((filter.bias_rps() - found).norm(), 2.0 * sigma(filter));
}

TEST(GyroBiasTest, FollowsABiasThatMoves) {
  GyroBias filter;
  Observer observer;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  for (int i = 0; i < 6000; ++i) {  // 1 mrad/s in a minute
    moved.x() = 1e-3 * i / 600.0;
    filter.observe(
        observer.difference(filter) - kPeriod_s * moved, kByBias, kCovariance, kPeriod_s);
  }
  EXPECT_NEAR(filter.bias_rps().x(), kTruth.x() + moved.x(), 5e-4);
}

}  // namespace
}  // namespace rotrocc
