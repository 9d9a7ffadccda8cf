#include "rig/bias_filter.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr double kNoise_px = 0.05;
constexpr double kShared_px = 0.13;
constexpr double kFx_px = 1.0 / BiasFilter::kPrior_rad;  // the prior is 1 px
constexpr double kPrior_px = 1.0;

BiasMeasurement measured(double bias_px) {
  BiasMeasurement measurement;
  measurement.bias_px = bias_px;
  measurement.noise_px2 = kNoise_px * kNoise_px;
  measurement.shared_px2 = kShared_px * kShared_px;
  return measurement;
}

TEST(BiasFilterTest, IsAsUncertainAsItsFirstMeasurement) {
  BiasFilter filter;
  EXPECT_DOUBLE_EQ(filter.bias(kFx_px).sigma_px, kPrior_px);
  filter.add(measured(0.1), kFx_px);
  const double variance_px2 = kNoise_px * kNoise_px + kShared_px * kShared_px;
  // The prior takes part, and the moving rig has a wider one.
  EXPECT_NEAR(filter.bias(kFx_px).sigma_px, std::sqrt(variance_px2 / (1.0 + variance_px2)), 0.002);
}

TEST(BiasFilterTest, SharedErrorsDoNotAverageOut) {
  BiasFilter filter;
  for (int pair = 0; pair < 1000; ++pair) filter.add(measured(0.1), kFx_px);
  EXPECT_GT(filter.bias(kFx_px).sigma_px, 0.9 * kShared_px) << "noise alone would be 0.0016 px";
}

TEST(BiasFilterTest, AppliesWhatIsBeyondDoubt) {
  BiasFilter doubtful;
  BiasFilter certain;
  for (int pair = 0; pair < 10; ++pair) {
    doubtful.add(measured(0.2), kFx_px);
    certain.add(measured(1.0), kFx_px);
  }
  EXPECT_NEAR(doubtful.bias(kFx_px).applied_px, 0.0, 0.01);
  EXPECT_GT(doubtful.bias(kFx_px).estimated_px, 0.1);
  EXPECT_NEAR(certain.bias(kFx_px).applied_px, 1.0, 0.05);
}

TEST(BiasFilterTest, AppliesWhatWasBeyondDoubt) {
  BiasFilter filter;
  BiasFilter doubtful;
  for (int pair = 0; pair < 10; ++pair) filter.add(measured(1.0), kFx_px);
  for (int pair = 0; pair < 30; ++pair) {
    filter.add(measured(0.6), kFx_px);  // 4.6 standard deviations
    doubtful.add(measured(0.6), kFx_px);
  }
  EXPECT_NEAR(doubtful.bias(kFx_px).applied_px, 0.0, 0.1);
  EXPECT_NEAR(filter.bias(kFx_px).applied_px, 0.6, 0.05);
  for (int pair = 0; pair < 30; ++pair) filter.add(measured(0.2), kFx_px);
  EXPECT_NEAR(filter.bias(kFx_px).applied_px, 0.0, 0.01);
}

TEST(BiasFilterTest, HardlyBelievesASingleOutlier) {
  BiasFilter filter;
  for (int pair = 0; pair < 30; ++pair) filter.add(measured(0.0), kFx_px);
  const double before_px = filter.bias(kFx_px).sigma_px;
  filter.add(measured(0.6), kFx_px);  // 4 standard deviations
  EXPECT_NEAR(filter.bias(kFx_px).applied_px, 0.0, 0.2);
  filter.add(measured(0.0), kFx_px);
  EXPECT_NEAR(filter.bias(kFx_px).estimated_px, 0.0, before_px);
}

TEST(BiasFilterTest, FollowsAStepWithinFourPairs) {
  BiasFilter filter;
  for (int pair = 0; pair < 30; ++pair) filter.add(measured(2.0), kFx_px);
  for (int pair = 0; pair < 4; ++pair) filter.add(measured(-1.0), kFx_px);
  EXPECT_NEAR(filter.bias(kFx_px).applied_px, -1.0, 2.0 * filter.bias(kFx_px).sigma_px);
  EXPECT_LT(filter.bias(kFx_px).sigma_px, 0.3);
}

TEST(BiasFilterTest, IsHonestAboutNoise) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  double square = 0.0;
  constexpr int kDrives = 200;
  for (int drive = 0; drive < kDrives; ++drive) {
    BiasFilter filter;
    const double truth_px = normal(generator);  // as the prior says
    const double lasting_px = kShared_px * normal(generator);
    for (int pair = 0; pair < 20; ++pair) {
      filter.add(measured(truth_px + lasting_px + kNoise_px * normal(generator)), kFx_px);
    }
    const double z = (filter.bias(kFx_px).estimated_px - truth_px) / filter.bias(kFx_px).sigma_px;
    square += z * z / kDrives;
  }
  // The scatter of a mean square of 200 is 0.1; heavy tails and the moving rig add some doubt.
  EXPECT_GT(std::sqrt(square), 0.8);
  EXPECT_LT(std::sqrt(square), 1.15);
}

}  // namespace
}  // namespace rotrocc
