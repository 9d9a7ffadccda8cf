#include "odometry/rig_estimate.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "motion/motion_estimator.h"
#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;

/// As measured on KITTI, without outliers.
const FeatureNoise kNoise = {0.12, 0.36};

Eigen::Isometry3d ahead() {
  return motion({0.0, 0.0, 1.2}, {0.0, 0.01, 0.0});
}

Correspondences biased(const Eigen::Isometry3d& T, unsigned seed, double bias_px) {
  return biasedFeatures(T, seed, kNoise, [=](const Eigen::Vector2d&) { return bias_px; });
}

/// Of the camera of KITTI, after a first keyframe.
RigEstimate rigOf(const StereoCalibratorConfig& config = {}) {
  OdometryConfig all;
  all.stereo_calibrator = config;
  RigEstimate rig(all);
  rig.setCamera(kittiCamera());
  return rig;
}

/// Without images, so that it says nothing of the rows.
void startKeyframe(RigEstimate& rig) {
  StereoFrame frame;
  frame.left = frame.right = {cv::Mat()};
  Keyframe keyframe;
  keyframe.frame = std::make_shared<StereoFrame>(frame);
  rig.startKeyframe(keyframe);
}

Hypothesis hypothesis(const StereoCamera& camera,
                      const Correspondences& features,
                      const Eigen::Isometry3d& T_keyframe_cur) {
  Hypothesis found;
  found.camera = camera;
  found.features = features;
  found.estimate.T_keyframe_cur = T_keyframe_cur;
  return found;
}

/// Estimates the motion of one pair and measures the bias at it, as the odometry does.
void show(Correspondences features, const Eigen::Isometry3d& truth, RigEstimate& rig) {
  const StereoCamera corrected = rig.correctedCamera();
  const double infinity_px = corrected.disparityAtInfinity();
  features.erase(std::remove_if(features.begin(),
                                features.end(),
                                [&](const Correspondence& feature) {
                                  return feature.disparity_px - infinity_px < 1.0;
                                }),
                 features.end());
  triangulate(corrected, features);
  const auto estimate = MotionEstimator().estimate(corrected, features, truth, kPeriod_s);
  ASSERT_TRUE(estimate.valid);
  startKeyframe(rig);
  rig.observeBias(hypothesis(corrected, features, estimate.T_keyframe_cur));
}

/// Simulates a drive of `pairs` pairs with a constant disparity bias.
void drive(double bias_px, int pairs, RigEstimate& rig, unsigned first_seed = 0) {
  for (int i = 0; i < pairs; ++i) {
    show(biased(ahead(), first_seed + static_cast<unsigned>(i), bias_px), ahead(), rig);
  }
}

TEST(RigEstimateTest, FindsTheBiasOfARig) {
  for (const double bias_px : {-0.5, 0.5, 1.0, 2.0}) {
    RigEstimate rig = rigOf();
    drive(bias_px, 30, rig);
    // Most of the uncertainty is that of shared errors, of which 30 pairs cannot show that there
    // are none.
    EXPECT_LT(rig.bias().sigma_px, 0.08);
    EXPECT_NEAR(rig.bias().estimated_px, bias_px, 2.0 * rig.bias().sigma_px);
    // Half a pixel is beyond 6 standard deviations, but not far.
    EXPECT_NEAR(rig.bias().applied_px, rig.bias().estimated_px, rig.bias().sigma_px);
    EXPECT_EQ(rig.correctedCamera().cx_right, kittiCamera().cx_right + rig.bias().applied_px);
  }
}

TEST(RigEstimateTest, ThePairObservedAgainCountsOnce) {
  RigEstimate once = rigOf();
  RigEstimate twice = rigOf();
  const Correspondences features = biased(ahead(), 1, 0.0);
  once.observeBias(hypothesis(kittiCamera(), features, ahead()));
  twice.observeBias(hypothesis(kittiCamera(), features, ahead()));
  twice.observeBias(hypothesis(twice.correctedCamera(), features, ahead()));
  // The second observation starts at another applied bias, hence the tolerance of its iterations.
  EXPECT_NEAR(once.bias().estimated_px, twice.bias().estimated_px, 0.005);
  EXPECT_NEAR(once.bias().sigma_px, twice.bias().sigma_px, 0.005);
}

TEST(RigEstimateTest, AddsAKnownBiasAndStopsThereIfNotEnabled) {
  StereoCalibratorConfig config;
  config.bias_px = 0.7;
  config.enabled = false;
  RigEstimate fixed = rigOf(config);
  drive(1.0, 10, fixed);
  EXPECT_EQ(fixed.bias().applied_px, 0.7);
  config.enabled = true;
  RigEstimate estimating = rigOf(config);
  EXPECT_EQ(estimating.bias().applied_px, 0.7);
  drive(1.5, 30, estimating);
  EXPECT_NEAR(estimating.bias().applied_px, 1.5, 0.1);
  StereoCamera other = kittiCamera();
  other.baseline_m *= 2.0;
  estimating.setCamera(other);
  EXPECT_EQ(estimating.bias().applied_px, 0.7);
}

TEST(RigEstimateTest, AddsNothingToTheCovarianceOnceItIsDisabled) {
  RigEstimate rig = rigOf();
  drive(0.5, 5, rig);
  EXPECT_FALSE(rig.motionCovariance().isZero(0.0));
  OdometryConfig disabled;
  disabled.stereo_calibrator.enabled = false;
  rig.configure(disabled);
  drive(0.5, 1, rig, 5);
  EXPECT_TRUE(rig.motionCovariance().isZero(0.0));
}

}  // namespace
}  // namespace rotrocc
