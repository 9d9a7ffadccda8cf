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
  MotionEstimatorConfig config;
  config.as_published = true;
  return config;
}

/// Runs only this estimator.
MotionEstimate estimate(const MotionEstimatorConfig& config,
                        const Correspondences& features,
                        const Eigen::Isometry3d& initial) {
  const StereoCamera camera = kittiCamera();
  ReprojectionProblem problem;
  MotionEstimate found;
  const double noise_ratio = config.as_published ? 0.0 : kDisparityNoiseRatio;
  TwoStageEstimator(config).estimate(
      {camera, features, noise_ratio}, all(features), initial, kPeriod_s, problem, found);
  EXPECT_EQ(problem.motion().matrix(), found.T_keyframe_cur.matrix());
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
  MotionEstimatorConfig one_stage = paper();
  one_stage.criterion = "reprojection";
  // The noise is larger than the flow, so stage 2 drops features in each iteration.
  const Eigen::Isometry3d step = motion({0.0, 0.0, 0.3}, {0.0, 0.0, 0.0});
  std::mt19937 generator(1);
  const auto features = simulateFeatures(kittiCamera(), step, 500, {3.0, 3.0}, generator);
  const MotionEstimate found = estimate(paper(), features, step);
  const MotionEstimate one = estimate(one_stage, features, step);
  ASSERT_TRUE(found.valid);
  EXPECT_TRUE(found.translation_failed);
  EXPECT_FALSE(found.has_translation_stage);
  EXPECT_EQ(found.T_keyframe_cur.matrix(), one.T_keyframe_cur.matrix());
  EXPECT_EQ(found.translation_inliers, found.rotation_inliers);
}

/// At walking pace, 4 % of the flow are less than its noise.
TEST(TwoStageEstimatorTest, DoesNotTakeNoiseForOutliersWhereTheFlowIsSmall) {
  const Eigen::Isometry3d step = motion({0.003, -0.001, 0.15}, {0.002, 0.03, -0.001});
  const FeatureNoise noise = {0.3, 0.9};
  std::mt19937 generator(1);
  Correspondences features = simulateFeatures(kittiCamera(), step, 500, noise, generator);
  for (std::size_t i = 0; i < 50; ++i) features[i].cur_px.y() += 8.0;
  for (const auto& [config, least, most] :
       {std::tuple(MotionEstimatorConfig(), 360, 450), std::tuple(paper(), 0, 150)}) {
    const MotionEstimate found = estimate(config, features, step);
    ASSERT_TRUE(found.has_translation_stage);
    EXPECT_GE(count(found.translation_inliers), least);
    EXPECT_LE(count(found.translation_inliers), most);
  }
}

}  // namespace
}  // namespace rotrocc
