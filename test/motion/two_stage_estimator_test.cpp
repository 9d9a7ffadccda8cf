#include "motion/two_stage_estimator.h"

#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "motion/feature_errors.h"
#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;

MotionEstimatorConfig paper() {
  OdometryConfig config;
  useMethodOfPaper(config);
  return config.motion_estimator;
}

/// Runs only this estimator.
MotionEstimate estimate(const MotionEstimatorConfig& config,
                        const Correspondences& features,
                        const Eigen::Isometry3d& initial) {
  const StereoCamera camera = kittiCamera();
  Fit fit;
  MotionEstimate found;
  TwoStageEstimator(config).estimate(
      {camera, features, config.noise_ratio}, all(features), initial, kPeriod_s, fit, found);
  EXPECT_EQ(fit.T_keyframe_cur.matrix(), found.T_keyframe_cur.matrix());
  return found;
}

MotionEstimate estimate(const MotionEstimatorConfig& config, const FeatureNoise& noise) {
  std::mt19937 generator(1);
  return estimate(config,
                  simulateFeatures(kittiCamera(), turnAhead(), 500, noise, generator),
                  roughly(turnAhead()));
}

TEST(TwoStageEstimatorTest, FindsTheMotionOfExactFeaturesByThePapersParameters) {
  const MotionEstimate found = estimate(paper(), {});
  ASSERT_TRUE(found.valid);
  EXPECT_TRUE(found.has_translation_stage);
  EXPECT_FALSE(found.translation_failed);
  EXPECT_EQ(count(found.rotation_inliers), 500);
  // The solver stops when a step changes the cost by less than 1e-6 px^2.
  EXPECT_LT(motionError(found.T_keyframe_cur, turnAhead()).norm(), 1e-5);
}

TEST(TwoStageEstimatorTest, StageTwoKeepsTheRotationOfStageOne) {
  MotionEstimatorConfig one_stage = paper();
  one_stage.criterion = "reprojection";
  const MotionEstimate one = estimate(one_stage, {0.3, 0.9});
  const MotionEstimate two = estimate(paper(), {0.3, 0.9});
  EXPECT_EQ(two.T_keyframe_cur.linear(), one.T_keyframe_cur.linear());
  EXPECT_NE(two.T_keyframe_cur.translation(), one.T_keyframe_cur.translation());
}

TEST(TwoStageEstimatorTest, FallsBackToStageOneIfStageTwoFails) {
  MotionEstimatorConfig strict = paper();
  strict.translation_initial_px = 1e-6;  // excludes noisy features
  MotionEstimatorConfig one_stage = paper();
  one_stage.criterion = "reprojection";
  const MotionEstimate found = estimate(strict, {0.3, 0.9});
  const MotionEstimate one = estimate(one_stage, {0.3, 0.9});
  ASSERT_TRUE(found.valid);
  EXPECT_TRUE(found.translation_failed);
  EXPECT_FALSE(found.has_translation_stage);
  EXPECT_EQ(found.T_keyframe_cur.matrix(), one.T_keyframe_cur.matrix());
  EXPECT_EQ(found.translation_inliers, found.rotation_inliers);
}

TEST(TwoStageEstimatorTest, StageTwoMayStartFromThePrediction) {
  MotionEstimatorConfig from_stage_one = paper();
  from_stage_one.translation_from_prediction = false;
  const Eigen::Isometry3d a = estimate(paper(), {0.3, 0.9}).T_keyframe_cur;
  const Eigen::Isometry3d b = estimate(from_stage_one, {0.3, 0.9}).T_keyframe_cur;
  // The same minimum, up to the solver's tolerance.
  EXPECT_NE(a.translation(), b.translation());
  EXPECT_LT((a.translation() - b.translation()).norm(), 1e-4);
}

/// At walking pace, 4 % of the flow are less than its noise.
TEST(TwoStageEstimatorTest, DoesNotTakeNoiseForOutliersWhereTheFlowIsSmall) {
  const Eigen::Isometry3d step = motion({0.003, -0.001, 0.15}, {0.002, 0.03, -0.001});
  const FeatureNoise noise = {0.3, 0.9};
  std::mt19937 generator(1);
  Correspondences features = simulateFeatures(kittiCamera(), step, 500, noise, generator);
  for (std::size_t i = 0; i < 50; ++i) features[i].cur_px.y() += 8.0;
  MotionEstimatorConfig of_the_noise;
  of_the_noise.robust_factor = of_the_noise.shared_ratio = 0.0;  // no refinement
  MotionEstimatorConfig of_the_flow = of_the_noise;
  of_the_flow.translation_noise_factor = 0.0;
  for (const auto& [config, least, most] :
       {std::tuple(of_the_noise, 360, 450), std::tuple(of_the_flow, 0, 150)}) {
    const MotionEstimate found = estimate(config, features, step);
    ASSERT_TRUE(found.has_translation_stage);
    EXPECT_GE(count(found.translation_inliers), least);
    EXPECT_LE(count(found.translation_inliers), most);
  }
}

}  // namespace
}  // namespace rotrocc
