#include "odometry/motion_check.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kDepth_m = 15.0;
constexpr double kNoiseRatio = 4.0;

FeatureSet set(int inliers, int features) {
  FeatureSet flags(static_cast<std::size_t>(features), 0);
  std::fill(flags.begin(), flags.begin() + inliers, 1);
  return flags;
}

/// 10 m/s straight ahead, with 300 inliers of 400 features.
MotionEstimator::Estimate goodEstimate() {
  MotionEstimator::Estimate estimate;
  estimate.valid = true;
  estimate.flow_noise_px = 0.1;
  estimate.T_keyframe_cur = motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  estimate.rotation_inliers = set(300, 400);
  estimate.translation_inliers = set(300, 400);
  return estimate;
}

void expectSays(const std::string& sentence, const std::string& value, const std::string& limit) {
  EXPECT_NE(sentence.find(value), std::string::npos) << sentence;
  EXPECT_NE(sentence.find(limit), std::string::npos) << sentence;
}

MotionCheck defaultCheck() {
  return {{}, kNoiseRatio};
}

std::string checkNotLost(const MotionEstimator::Estimate& estimate) {
  return defaultCheck().checkNotLost(estimate, Eigen::Isometry3d::Identity(), kPeriod_s);
}

/// Exact features all over the image (the R2 sequence of Roberts, 2018), so that the first ones are
/// as well.
Correspondences featuresAt(double depth_m, const Eigen::Isometry3d& T_keyframe_cur, int count) {
  const StereoCamera camera = kittiCamera();
  Correspondences features(static_cast<std::size_t>(count));
  double x = 0.5;
  double y = 0.5;
  for (Correspondence& feature : features) {
    x = std::fmod(x + 0.7548776662, 1.0);
    y = std::fmod(y + 0.5698402910, 1.0);
    feature.cur_px = {x * camera.width, y * camera.height};
    feature.disparity_px = camera.disparity(depth_m);
    feature.point_cur = depth_m * camera.ray(feature.cur_px);
    feature.keyframe_px = camera.project(T_keyframe_cur * feature.point_cur);
  }
  return features;
}

/// All features are equally deep and fit the motion, and all of the keyframe's features were
/// tracked.
Hypothesis hypothesis(const MotionEstimator::Estimate& estimate) {
  Hypothesis hypothesis;
  hypothesis.camera = kittiCamera();
  hypothesis.has_prediction = true;
  hypothesis.estimate = estimate;
  hypothesis.features = featuresAt(
      kDepth_m, estimate.T_keyframe_cur, static_cast<int>(estimate.rotation_inliers.size()));
  hypothesis.counts.with_depth = static_cast<int>(hypothesis.features.size());
  return hypothesis;
}

std::string whyDegraded(const MotionEstimator::Estimate& estimate) {
  return defaultCheck().whyDegraded(hypothesis(estimate), estimate.covariance);
}

TEST(MotionCheckTest, BelievesAGoodMotion) {
  EXPECT_EQ(checkNotLost(goodEstimate()), "");
  EXPECT_EQ(whyDegraded(goodEstimate()), "");
}

TEST(MotionCheckTest, WantsEnoughFeatures) {
  auto estimate = goodEstimate();
  estimate.rotation_inliers = estimate.translation_inliers = set(24, 24);
  expectSays(checkNotLost(estimate), "24 features were matched", "min_inliers = 25");
  estimate.rotation_inliers = estimate.translation_inliers = set(25, 25);
  EXPECT_EQ(checkNotLost(estimate), "");
  estimate.rotation_inliers = estimate.translation_inliers = {};
  expectSays(checkNotLost(estimate), "only 0 features", "min_inliers = 25");
}

TEST(MotionCheckTest, WantsAValidMotion) {
  auto estimate = goodEstimate();
  estimate.valid = false;
  expectSays(checkNotLost(estimate), "determine no motion", "");
}

TEST(MotionCheckTest, WantsEnoughInliersInBothStages) {
  auto estimate = goodEstimate();
  estimate.translation_inliers = set(24, 400);
  expectSays(checkNotLost(estimate), "24 features agree", "min_inliers = 25");
  estimate = goodEstimate();
  estimate.rotation_inliers = set(24, 400);
  expectSays(checkNotLost(estimate), "24 features agree", "min_inliers = 25");
}

TEST(MotionCheckTest, WantsAShareOfInliers) {
  auto estimate = goodEstimate();
  estimate.translation_inliers = set(59, 400);
  expectSays(checkNotLost(estimate), "0.1475", "min_inlier_share = 0.15");
  estimate.translation_inliers = set(60, 400);
  EXPECT_EQ(checkNotLost(estimate), "");
}

TEST(MotionCheckTest, KnowsHowFastARobotMoves) {
  const Eigen::Isometry3d kStart = Eigen::Isometry3d::Identity();
  auto estimate = goodEstimate();
  estimate.T_keyframe_cur = motion({0.0, 4.0, 5.9}, {0.0, 0.0, 0.0});
  expectSays(checkNotLost(estimate), "71.28", "max_speed_mps = 70");
  EXPECT_EQ(defaultCheck().checkNotLost(estimate, kStart, 2.0 * kPeriod_s), "");  // half the speed
  estimate.T_keyframe_cur = motion({0.0, 0.0, 1.0}, {0.0, 0.61, 0.0});
  expectSays(checkNotLost(estimate), "6.1 rad/s", "max_turn_rate_rps = 6");
  EXPECT_EQ(defaultCheck().checkNotLost(estimate, kStart, 2.0 * kPeriod_s), "");
}

TEST(MotionCheckTest, CallsAMotionOnFewSurvivorsDegraded) {
  auto estimate = goodEstimate();
  Hypothesis tracked = hypothesis(estimate);
  tracked.counts.with_depth = 3001;
  expectSays(defaultCheck().whyDegraded(tracked, estimate.covariance),
             "300 of 3001 features",
             "a share below 0.1");
  tracked.counts.with_depth = 3000;
  EXPECT_EQ(defaultCheck().whyDegraded(tracked, estimate.covariance), "");
}

TEST(MotionCheckTest, DoesNotMindASmallImage) {
  auto estimate = goodEstimate();
  estimate.translation_inliers = estimate.rotation_inliers = set(30, 40);
  EXPECT_EQ(whyDegraded(estimate), "");
}

TEST(MotionCheckTest, CallsAnUndeterminedTranslationDegraded) {
  auto estimate = goodEstimate();  // 1 m
  estimate.covariance(0, 0) = 0.03 * 0.03;
  estimate.covariance(2, 2) = 0.041 * 0.041;
  expectSays(whyDegraded(estimate), "0.0508", "a share of 0.05 of 1 m");
  estimate.covariance(2, 2) = 0.039 * 0.039;
  EXPECT_EQ(whyDegraded(estimate), "");
}

TEST(MotionCheckTest, ComparesAShortStepWithTheScene) {
  auto estimate = goodEstimate();
  estimate.T_keyframe_cur.setIdentity();
  estimate.covariance(2, 2) = 0.0149 * 0.0149;
  EXPECT_EQ(whyDegraded(estimate), "");
  estimate.covariance(2, 2) = 0.0151 * 0.0151;
  expectSays(whyDegraded(estimate), "0.0151 m", "of 0.3 m");
}

TEST(MotionCheckTest, CallsAMotionOnASmallShareDegraded) {
  auto estimate = goodEstimate();
  estimate.translation_inliers = set(199, 400);
  expectSays(whyDegraded(estimate), "0.4975", "the translation, less than 0.5");
  estimate.translation_inliers = set(200, 400);
  EXPECT_EQ(whyDegraded(estimate), "");
  estimate.rotation_inliers = set(279, 400);
  expectSays(whyDegraded(estimate), "0.6975", "the motion, less than 0.7");
  estimate.rotation_inliers = set(280, 400);
  EXPECT_EQ(whyDegraded(estimate), "");
}

TEST(MotionCheckTest, WantsMoreAgreementWithoutAPrediction) {
  auto estimate = goodEstimate();
  estimate.rotation_inliers = set(319, 400);
  Hypothesis first = hypothesis(estimate);
  EXPECT_EQ(defaultCheck().whyDegraded(first, estimate.covariance), "");
  first.has_prediction = false;
  expectSays(defaultCheck().whyDegraded(first, estimate.covariance),
             "without a prediction, a share of 0.7975",
             "less than 0.8");
  first.estimate.rotation_inliers = set(320, 400);
  EXPECT_EQ(defaultCheck().whyDegraded(first, estimate.covariance), "");
}

TEST(MotionCheckTest, AStartOnFeaturesMoreExactThanImagesIsDegraded) {
  auto estimate = goodEstimate();
  estimate.rotation_inliers = set(360, 400);
  estimate.flow_noise_px = 0.004;
  Hypothesis first = hypothesis(estimate);
  EXPECT_EQ(defaultCheck().whyDegraded(first, estimate.covariance), "");
  first.has_prediction = false;
  expectSays(defaultCheck().whyDegraded(first, estimate.covariance), "0.9", "0.004 px");
  first.estimate.rotation_inliers = set(400, 400);
  EXPECT_EQ(defaultCheck().whyDegraded(first, estimate.covariance), "") << "the same image twice";
}

TEST(MotionCheckTest, CallsAMotionDegradedIfFewCornersHaveADepth) {
  const auto estimate = goodEstimate();
  Hypothesis dirty = hypothesis(estimate);
  dirty.counts.corners = 2667;
  expectSays(defaultCheck().whyDegraded(dirty, estimate.covariance),
             "400 of 2667 corners",
             "a share below 0.15");
  dirty.counts.corners = 2666;
  EXPECT_EQ(defaultCheck().whyDegraded(dirty, estimate.covariance), "");
}

/// 300 features that fit the motion, and 100 others.
Hypothesis hypothesisAnd(const Correspondences& others) {
  constexpr int kFitting = 300;
  std::mt19937 generator(1);
  Hypothesis mixed = hypothesis(goodEstimate());
  mixed.features = simulateFeatures(
      kittiCamera(), mixed.estimate.T_keyframe_cur, kFitting, {0.2, 0.2}, generator);
  mixed.features.insert(mixed.features.end(), others.begin(), others.end());
  return mixed;
}

TEST(MotionCheckTest, CallsAMotionBesideAnotherOneDegraded) {
  std::mt19937 generator(2);
  const auto other = motion({0.5, 0.0, 0.2}, {0.0, 0.02, 0.0});
  const Correspondences on_lorry =
      simulateFeatures(kittiCamera(), other, 100, {0.2, 0.2}, generator);
  const Hypothesis mixed = hypothesisAnd(on_lorry);
  const Matrix6d covariance = Matrix6d::Zero();
  expectSays(defaultCheck().whyDegraded(mixed, covariance),
             "another motion fits",
             "of the 400 features, a share above 0.2");
  Correspondences few(on_lorry.begin(), on_lorry.begin() + 70);
  EXPECT_EQ(defaultCheck().whyDegraded(hypothesisAnd(few), covariance), "");
}

TEST(MotionCheckTest, FewerAreEnoughBehindTheOthers) {
  const auto other = motion({0.5, 0.0, 0.2}, {0.0, 0.02, 0.0});
  const auto whyBeside = [&](double depth_m, int count) {
    Hypothesis mixed = hypothesis(goodEstimate());
    const Correspondences others = featuresAt(depth_m, other, count);
    std::copy(others.begin(), others.end(), mixed.features.end() - count);
    return defaultCheck().whyDegraded(mixed, Matrix6d::Zero());
  };
  expectSays(whyBeside(2.1 * kDepth_m, 40), "40 of the 400 features, which are behind", "half of");
  // Too few for that. They are still degraded: the other features have most of the information.
  expectSays(whyBeside(2.1 * kDepth_m, 39), "few features determine it", "");
  expectSays(whyBeside(kDepth_m, 79), "few features determine it", "");
}

TEST(MotionCheckTest, CallsAMotionThatOneFeatureDeterminesDegraded) {
  auto estimate = goodEstimate();
  estimate.rotation_inliers = estimate.translation_inliers = set(400, 400);
  Hypothesis far = hypothesis(estimate);
  far.features = featuresAt(2000.0, estimate.T_keyframe_cur, 400);
  const auto bringNear = [&](int count) {
    const Correspondences near = featuresAt(kDepth_m, estimate.T_keyframe_cur, count);
    std::copy(near.begin(), near.end(), far.features.begin());
  };
  bringNear(1);
  expectSays(defaultCheck().whyDegraded(far, Matrix6d::Zero()), "information", "less than 0.15");
  bringNear(40);
  EXPECT_EQ(defaultCheck().whyDegraded(far, Matrix6d::Zero()), "");
}

TEST(MotionCheckTest, FeaturesThatAgreeOnNothingAreNoOtherMotion) {
  std::mt19937 generator(3);
  Correspondences wrong =
      simulateFeatures(kittiCamera(), goodEstimate().T_keyframe_cur, 100, {0.2, 0.2}, generator);
  std::uniform_real_distribution<double> offset_px(-40.0, 40.0);
  for (Correspondence& feature : wrong) {
    feature.keyframe_px += Eigen::Vector2d(offset_px(generator), offset_px(generator));
  }
  EXPECT_EQ(defaultCheck().whyDegraded(hypothesisAnd(wrong), Matrix6d::Zero()), "");
}

TEST(MotionCheckTest, WantsAReserveOfInliersForTheNextPair) {
  auto estimate = goodEstimate();
  EXPECT_TRUE(defaultCheck().hasReserve(estimate));
  estimate.translation_inliers = estimate.rotation_inliers = set(49, 300);
  EXPECT_FALSE(defaultCheck().hasReserve(estimate));
  EXPECT_EQ(checkNotLost(estimate), "") << "this one is accepted";
}

/// Whether the camera rests after a motion, if the flow has this noise.
bool isAtRest(const Eigen::Isometry3d& T_keyframe_cur, double noise_px = 0.2, int features = 400) {
  std::mt19937 generator(1);
  Hypothesis accepted;
  accepted.camera = kittiCamera();
  accepted.estimate.T_keyframe_cur = T_keyframe_cur;
  accepted.estimate.flow_noise_px = noise_px;
  accepted.features =
      simulateFeatures(accepted.camera, T_keyframe_cur, features, {noise_px, noise_px}, generator);
  accepted.estimate.rotation_inliers.assign(accepted.features.size(), 1);
  return defaultCheck().isAtRest(accepted);
}

TEST(MotionCheckTest, TellsRestFromMotion) {
  EXPECT_TRUE(isAtRest(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(isAtRest(motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0})));
  EXPECT_FALSE(isAtRest(motion({0.0, 0.0, 0.0}, {0.0, 0.01, 0.0}))) << "7 px at this focal length";
}

TEST(MotionCheckTest, RestIsRelativeToTheNoise) {
  const Eigen::Isometry3d slow = motion({0.0, 0.0, 0.0}, {0.0, 0.004, 0.0});  // 2.9 px
  EXPECT_FALSE(isAtRest(slow, 0.2));
  EXPECT_TRUE(isAtRest(slow, 0.4));
}

TEST(MotionCheckTest, RestNeedsAFeature) {
  EXPECT_FALSE(isAtRest(Eigen::Isometry3d::Identity(), 0.2, 0));
}

TEST(MotionCheckTest, CallsAJumpDegraded) {
  const Eigen::Isometry3d expected = motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  UncertainTransform jump;
  jump.T = motion({0.0, 0.0, 1.31}, {0.0, 0.0, 0.0});
  const MotionCheck check = defaultCheck();
  expectSays(check.whyJump(jump, expected, kPeriod_s), "31 m/s2", "max_acceleration_mps2 = 30");
  EXPECT_EQ(check.whyJump(jump, expected, 2.0 * kPeriod_s), "");  // a quarter of the acceleration
  jump.covariance(2, 2) = 0.01 * 0.01;  // 3 sigma = 0.03 m, equivalent to 3 m/s2
  EXPECT_EQ(check.whyJump(jump, expected, kPeriod_s), "");
  jump.T = motion({0.31, 0.0, 1.0}, {0.0, 0.0, 0.0});
  jump.covariance.setZero();
  EXPECT_NE(check.whyJump(jump, expected, kPeriod_s), "");
}

TEST(MotionCheckTest, AMotionWithoutItsTranslationStageIsDegraded) {
  auto estimate = goodEstimate();
  estimate.translation_failed = true;
  EXPECT_EQ(checkNotLost(estimate), "");
  expectSays(whyDegraded(estimate), "translation stage", "min_inliers");
  estimate.translation_inliers = estimate.rotation_inliers = set(35, 49);
  EXPECT_EQ(whyDegraded(estimate), "") << "25 of 49 are more than half";
}

}  // namespace
}  // namespace rotrocc
