#include "rig/noise_estimator.h"

#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr int kFeatures = 500;

/// The parameters let any of the ratios tested be found.
NoiseEstimator::Config unbounded() {
  NoiseEstimator::Config config;
  config.max_ratio = 20.0;
  return config;
}

Eigen::Isometry3d ahead() {
  return motion({0.05, 0.0, 1.2}, {0.0, 0.01, 0.0});
}

/// Shows pairs whose disparities are also wrong by what `error_px` says of a pixel.
template <class Error>
void drive(const MeasurementNoise& noise,
           int pairs,
           NoiseEstimator& estimator,
           const Error& error_px,
           const Eigen::Isometry3d& T = ahead()) {
  for (int pair = 0; pair < pairs; ++pair) {
    std::mt19937 generator(static_cast<unsigned>(pair));
    Correspondences features = simulateFeatures(kittiCamera(), T, kFeatures, noise, generator);
    for (Correspondence& feature : features) feature.disparity_px += error_px(feature.cur_px);
    triangulate(kittiCamera(), features);
    estimator.observe(kittiCamera(), features, FeatureSet(features.size(), 1), T);
  }
}

double none(const Eigen::Vector2d&) {
  return 0.0;
}

TEST(NoiseEstimatorTest, FindsTheNoiseOfFlowAndDisparity) {
  for (const double ratio : {1.0, 2.0, 4.0}) {
    const MeasurementNoise noise = {0.15, 0.15 * ratio};
    for (const double first : {1.0, 3.0}) {
      NoiseEstimator estimator(unbounded(), first);
      drive(noise, 100, estimator, none);
      // Some 30000 features: their variances are known to 1 %, the ratio less well where it is
      // small, as most of the residual along j is then the flow's.
      EXPECT_NEAR(estimator.noise().flow_px, noise.flow_px, 0.01 * noise.flow_px);
      EXPECT_NEAR(estimator.noise().ratio, ratio, 0.05 * ratio) << "from " << first;
      EXPECT_EQ(estimator.noise().disparity_px,
                estimator.noise().ratio * estimator.noise().flow_px);
    }
  }
}

TEST(NoiseEstimatorTest, TakesWhatNeighboursShareForNoNoise) {
  // Far more than the noise, but smooth over the image.
  const auto lens = [](const Eigen::Vector2d& pixel) {
    const double x = (pixel.x() - kittiCamera().cx) / kittiCamera().fx;
    return 1.0 * x * x;
  };
  NoiseEstimator estimator(unbounded(), 3.0);
  drive({0.15, 0.3}, 100, estimator, lens);
  EXPECT_NEAR(estimator.noise().ratio, 2.0, 0.3);
}

TEST(NoiseEstimatorTest, BelievesNoMoreThanItMay) {
  NoiseEstimator::Config config;
  config.max_ratio = 3.0;
  NoiseEstimator estimator(config, 2.0);
  drive({0.1, 0.6}, 50, estimator, none);
  EXPECT_EQ(estimator.noise().ratio, 3.0);
}

TEST(NoiseEstimatorTest, LearnsNoRatioAtStandstill) {
  NoiseEstimator estimator(unbounded(), 3.0);
  drive({0.1, 0.1}, 50, estimator, none, Eigen::Isometry3d::Identity());
  EXPECT_EQ(estimator.noise().ratio, 3.0);
}

TEST(NoiseEstimatorTest, FollowsANoiseThatChanges) {
  NoiseEstimator::Config config = unbounded();
  config.memory_pairs = 20.0;
  NoiseEstimator estimator(config, 3.0);
  drive({0.1, 0.4}, 60, estimator, none);
  drive({0.2, 0.2}, 100, estimator, none);
  // exp(-100 / 20) = 0.7 % of the squared ratio of before is left, 0.11 of 1.
  EXPECT_NEAR(estimator.noise().ratio, 1.0, 0.12);
  EXPECT_NEAR(estimator.noise().flow_px, 0.2, 0.01);
}

TEST(NoiseEstimatorTest, KeepsItsRatioIfNotEnabled) {
  NoiseEstimator::Config config;
  config.enabled = false;
  for (const auto& [estimator_config, first] :
       {std::pair(config, 2.5), std::pair(NoiseEstimator::Config(), 0.0)}) {
    NoiseEstimator estimator(estimator_config, first);
    drive({0.1, 0.1}, 10, estimator, none);
    EXPECT_EQ(estimator.noise().ratio, first);
    EXPECT_GT(estimator.noise().flow_px, 0.0);
  }
}

TEST(NoiseEstimatorTest, BeginsAnewAfterAReset) {
  NoiseEstimator estimator(unbounded(), 3.0);
  drive({0.1, 0.1}, 10, estimator, none);
  ASSERT_LT(estimator.noise().ratio, 2.0);
  estimator.reset();
  EXPECT_EQ(estimator.noise().ratio, 3.0);
  EXPECT_EQ(estimator.noise().flow_px, 0.0);
}

}  // namespace
}  // namespace rotrocc
