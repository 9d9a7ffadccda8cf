#include "rig/stereo_calibrator.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "motion/motion_estimator.h"
#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kSharedRatio = 1.0;
constexpr double kRobustFactor = 1.5;

/// As measured on KITTI, without outliers.
const FeatureNoise kNoise = {0.12, 0.36};

Eigen::Isometry3d ahead() {
  return motion({0.0, 0.0, 1.2}, {0.0, 0.01, 0.0});
}

Correspondences biased(const Eigen::Isometry3d& T, unsigned seed, double bias_px) {
  return biasedFeatures(T, seed, kNoise, [=](const Eigen::Vector2d&) { return bias_px; });
}

/// Estimates the motion of one pair and passes it to the calibrator, as the odometry does.
void show(Correspondences features, const Eigen::Isometry3d& truth, StereoCalibrator& calibrator) {
  const StereoCamera corrected = calibrator.correct(kittiCamera());
  const double infinity_px = corrected.disparityAtInfinity();
  features.erase(std::remove_if(features.begin(),
                                features.end(),
                                [&](const Correspondence& feature) {
                                  return feature.disparity_px - infinity_px < 1.0;
                                }),
                 features.end());
  triangulate(corrected, features);
  const auto estimate = MotionEstimator({}).estimate(corrected, features, truth, kPeriod_s);
  ASSERT_TRUE(estimate.valid);
  calibrator.advance();
  calibrator.observe(
      corrected, features, estimate.rotation_inliers, estimate.T_keyframe_cur, kSharedRatio);
}

/// Simulates a drive of `pairs` pairs with a constant disparity bias.
void drive(double bias_px, int pairs, StereoCalibrator& calibrator, unsigned first_seed = 0) {
  for (int i = 0; i < pairs; ++i) {
    show(biased(ahead(), first_seed + static_cast<unsigned>(i), bias_px), ahead(), calibrator);
  }
}

TEST(StereoCalibratorTest, FindsTheBiasOfARig) {
  for (const double bias_px : {-0.5, 0.5, 1.0, 2.0}) {
    StereoCalibrator calibrator({}, kRobustFactor);
    drive(bias_px, 30, calibrator);
    // Most of the uncertainty is that of shared errors, of which 30 pairs cannot show that there
    // are none.
    EXPECT_LT(calibrator.bias().sigma_px, 0.08);
    EXPECT_NEAR(calibrator.bias().estimated_px, bias_px, 2.0 * calibrator.bias().sigma_px);
    EXPECT_NEAR(calibrator.bias().applied_px, calibrator.bias().estimated_px, 0.01);
    EXPECT_EQ(calibrator.correct(kittiCamera()).cx_right,
              kittiCamera().cx_right + calibrator.bias().applied_px);
  }
}

TEST(StereoCalibratorTest, LeavesAPerfectRigAlone) {
  StereoCalibrator calibrator({}, kRobustFactor);
  for (unsigned pair = 0; pair < 50; ++pair) {
    drive(0.0, 1, calibrator, pair);
    EXPECT_LE(std::abs(calibrator.bias().applied_px), 0.02) << pair;
  }
  EXPECT_NEAR(calibrator.bias().estimated_px, 0.0, 0.05);
}

TEST(StereoCalibratorTest, LearnsAndForgetsNothingAtStandstill) {
  StereoCalibrator unaware({}, kRobustFactor);
  StereoCalibrator aware({}, kRobustFactor);
  drive(1.0, 30, aware);
  const double before_px = aware.bias().applied_px;
  const Eigen::Isometry3d rest = Eigen::Isometry3d::Identity();
  for (unsigned pair = 0; pair < 100; ++pair) {
    show(biased(rest, pair, 1.0), rest, unaware);
    show(biased(rest, pair, 1.0), rest, aware);
    EXPECT_NEAR(unaware.bias().applied_px, 0.0, 0.002) << pair;  // no visible depth error
  }
  EXPECT_GT(unaware.bias().sigma_px, 0.5);
  EXPECT_NEAR(aware.bias().applied_px, before_px, 0.02);
}

TEST(StereoCalibratorTest, IsNotFooledByAMovingObject) {
  StereoCalibrator calibrator({}, kRobustFactor);
  for (unsigned pair = 0; pair < 50; ++pair) {
    Correspondences features = biased(ahead(), pair, 0.0);
    std::mt19937 generator(pair + 1000);
    putOnTruck(features, features.size() / 4, ahead(), kNoise, generator);
    show(features, ahead(), calibrator);
    EXPECT_LE(std::abs(calibrator.bias().applied_px), 0.05) << pair;
  }
}

TEST(StereoCalibratorTest, ThePairObservedAgainCountsOnce) {
  StereoCalibrator once({}, kRobustFactor);
  StereoCalibrator twice({}, kRobustFactor);
  const Correspondences features = biased(ahead(), 1, 0.0);
  once.observe(kittiCamera(), features, all(features), ahead(), kSharedRatio);
  twice.observe(kittiCamera(), features, all(features), ahead(), kSharedRatio);
  twice.observe(twice.correct(kittiCamera()), features, all(features), ahead(), kSharedRatio);
  // The second observation starts at another applied bias, hence the tolerance of its iterations.
  EXPECT_NEAR(once.bias().estimated_px, twice.bias().estimated_px, 0.005);
  EXPECT_NEAR(once.bias().sigma_px, twice.bias().sigma_px, 0.005);
}

TEST(StereoCalibratorTest, FollowsARigThatMoves) {
  StereoCalibrator calibrator({}, kRobustFactor);
  double square_px2 = 0.0;
  for (unsigned pair = 0; pair < 60; ++pair) {
    const double bias_px = 2.0 * std::sin(0.4 * pair);
    drive(bias_px, 1, calibrator, pair);
    const double off_px = calibrator.bias().applied_px - bias_px;
    if (pair >= 10) square_px2 += off_px * off_px / 50.0;
  }
  // What is left is less than a third of the motion of the rig, which is 1.4 px.
  EXPECT_LT(std::sqrt(square_px2), 0.45);
}

TEST(StereoCalibratorTest, AddsAKnownBiasAndStopsThereIfNotEnabled) {
  StereoCalibrator::Config config;
  config.bias_px = 0.7;
  config.enabled = false;
  StereoCalibrator fixed(config, kRobustFactor);
  drive(1.0, 10, fixed);
  EXPECT_EQ(fixed.bias().applied_px, 0.7);
  config.enabled = true;
  StereoCalibrator estimating(config, kRobustFactor);
  EXPECT_EQ(estimating.bias().applied_px, 0.7);
  drive(1.0, 30, estimating);
  EXPECT_NEAR(estimating.bias().applied_px, 1.0, 0.1);
  estimating.reset();
  EXPECT_EQ(estimating.bias().applied_px, 0.7);
}

TEST(StereoCalibratorTest, AddsNothingToTheCovarianceOnceItIsDisabled) {
  StereoCalibrator calibrator({}, kRobustFactor);
  drive(0.5, 5, calibrator);
  EXPECT_FALSE(calibrator.motionCovariance().isZero(0.0));
  StereoCalibrator::Config disabled;
  disabled.enabled = false;
  calibrator.configure(disabled, kRobustFactor);
  drive(0.5, 1, calibrator, 5);
  EXPECT_TRUE(calibrator.motionCovariance().isZero(0.0));
}

}  // namespace
}  // namespace rotrocc
