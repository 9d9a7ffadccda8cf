#include "motion/motion_solver.h"

#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kNoiseRatio = 3.0;

Correspondences exactFeatures(int count) {
  std::mt19937 generator(1);
  return simulateFeatures(kittiCamera(), turnAhead(), count, {}, generator);
}

/// From all features.
bool solve(Unknowns unknowns,
           double noise_ratio,
           const Correspondences& features,
           Eigen::Isometry3d& T_keyframe_cur) {
  const StereoCamera camera = kittiCamera();
  ReprojectionProblem problem;
  problem.assign({camera, features, noise_ratio}, T_keyframe_cur);
  const bool solved = solve(unknowns, all(features), problem);
  T_keyframe_cur = problem.motion();
  return solved;
}

TEST(MotionSolverTest, RecoversAnExactMotion) {
  for (const double noise_ratio : {0.0, kNoiseRatio}) {
    for (const int features : {3, 10, 300}) {
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      ASSERT_TRUE(solve(Unknowns::kMotion, noise_ratio, exactFeatures(features), T));
      // Gauss-Newton converges quadratically, and the last step was below 1e-7. With three points,
      // which determine the motion poorly, the solver stops at residuals below 1e-8 px.
      const double max_error = features == 3 ? 1e-5 : 1e-9;
      EXPECT_LT(motionError(T, turnAhead()).norm(), max_error) << features << ' ' << noise_ratio;
    }
  }
}

TEST(MotionSolverTest, RecoversAnExactTranslationAndLeavesTheRotation) {
  Eigen::Isometry3d T = turnAhead();
  T.translation().setZero();
  ASSERT_TRUE(solve(Unknowns::kTranslation, kNoiseRatio, exactFeatures(100), T));
  EXPECT_LT(motionError(T, turnAhead()).norm(), 1e-9);
  EXPECT_EQ(T.linear(), turnAhead().linear());
}

TEST(MotionSolverTest, RejectsTooFewFeatures) {
  const Eigen::Isometry3d before = motion({1.0, 2.0, 3.0}, {0.1, 0.2, 0.3});
  Eigen::Isometry3d T = before;
  EXPECT_FALSE(solve(Unknowns::kMotion, kNoiseRatio, exactFeatures(2), T));
  EXPECT_FALSE(solve(Unknowns::kTranslation, kNoiseRatio, exactFeatures(1), T));
  EXPECT_FALSE(solve(Unknowns::kMotion, kNoiseRatio, {}, T));
  EXPECT_EQ(T.matrix(), before.matrix());
  EXPECT_TRUE(solve(Unknowns::kTranslation, kNoiseRatio, exactFeatures(2), T));
}

}  // namespace
}  // namespace rotrocc
