#include "motion/two_stage_estimator.h"

#include <random>

#include <gtest/gtest.h>

#include "motion/feature_errors.h"
#include "support/simulated_features.h"

namespace rotrocc {
namespace {

/// Runs only this estimator.
MotionEstimate estimate(const Correspondences& features, const Eigen::Isometry3d& initial) {
  const StereoCamera camera = kittiCamera();
  ReprojectionProblem problem;
  MotionEstimate found;
  TwoStageEstimator().estimate(
      {camera, features, kDisparityNoiseRatio}, all(features), initial, problem, found);
  EXPECT_EQ(problem.motion().matrix(), found.T_keyframe_cur.matrix());
  return found;
}

TEST(TwoStageEstimatorTest, FindsTheMotionOfExactFeatures) {
  std::mt19937 generator(1);
  const MotionEstimate found = estimate(
      simulateFeatures(kittiCamera(), turnAhead(), 500, {}, generator), roughly(turnAhead()));
  ASSERT_TRUE(found.valid);
  EXPECT_TRUE(found.has_translation_stage);
  EXPECT_FALSE(found.translation_failed);
  EXPECT_EQ(count(found.rotation_inliers), 500);
  // The solver stops when a step changes the cost by less than 1e-6 px^2.
  EXPECT_LT(motionError(found.T_keyframe_cur, turnAhead()).norm(), 1e-5);
}

/// At walking pace, 4 % of the flow are less than its noise.
TEST(TwoStageEstimatorTest, DoesNotTakeNoiseForOutliersWhereTheFlowIsSmall) {
  const Eigen::Isometry3d step = motion({0.003, -0.001, 0.15}, {0.002, 0.03, -0.001});
  const FeatureNoise noise = {0.3, 0.9};
  std::mt19937 generator(1);
  Correspondences features = simulateFeatures(kittiCamera(), step, 500, noise, generator);
  for (std::size_t i = 0; i < 50; ++i) features[i].cur_px.y() += 8.0;
  const MotionEstimate found = estimate(features, step);
  ASSERT_TRUE(found.has_translation_stage);
  EXPECT_GE(count(found.translation_inliers), 360);
  EXPECT_LE(count(found.translation_inliers), 450);
}

}  // namespace
}  // namespace rotrocc
