#include "motion/motion_solver.h"

#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kNoiseRatio = 3.0;

Correspondences exactFeatures(int count) {
  std::mt19937 generator(1);
  return simulateFeatures(kittiCamera(), turnAhead(), count, {}, generator);
}

using Method = bool (MotionSolver::*)(const Measurements&, const FeatureSet&, Fit&);
constexpr Method kMotion = &MotionSolver::solveMotion;
constexpr Method kTranslation = &MotionSolver::solveTranslation;

/// From all features.
bool solve(Method method,
           double noise_ratio,
           const Correspondences& features,
           Eigen::Isometry3d& T_keyframe_cur) {
  const StereoCamera camera = kittiCamera();
  const Measurements measured = {camera, features, noise_ratio};
  MotionSolver solver({});
  Fit fit;
  fitAt(measured, T_keyframe_cur, fit);
  const bool solved = (solver.*method)(measured, all(features), fit);
  T_keyframe_cur = fit.T_keyframe_cur;
  return solved;
}

TEST(MotionSolverTest, RecoversAnExactMotion) {
  for (const double noise_ratio : {0.0, kNoiseRatio}) {
    for (const int features : {3, 10, 300}) {
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      ASSERT_TRUE(solve(kMotion, noise_ratio, exactFeatures(features), T));
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
  ASSERT_TRUE(solve(kTranslation, kNoiseRatio, exactFeatures(100), T));
  EXPECT_LT(motionError(T, turnAhead()).norm(), 1e-9);
  EXPECT_EQ(T.linear(), turnAhead().linear());
}

TEST(MotionSolverTest, RefusesTooFewFeatures) {
  const Eigen::Isometry3d before = motion({1.0, 2.0, 3.0}, {0.1, 0.2, 0.3});
  Eigen::Isometry3d T = before;
  EXPECT_FALSE(solve(kMotion, kNoiseRatio, exactFeatures(2), T));
  EXPECT_FALSE(solve(kTranslation, kNoiseRatio, exactFeatures(1), T));
  EXPECT_FALSE(solve(kMotion, kNoiseRatio, {}, T));
  EXPECT_EQ(T.matrix(), before.matrix());
  EXPECT_TRUE(solve(kTranslation, kNoiseRatio, exactFeatures(2), T));
}

/// Mean signed relative error of the step length for far points, and its standard error. The
/// disparities are about 2 to 6 px.
std::pair<double, double> biasOfStep(double noise_ratio) {
  constexpr int kDraws = 200;
  const Eigen::Isometry3d truth = motion({0.0, 0.0, 2.5}, {0.0, 0.0, 0.0});
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> side_m(-30.0, 30.0);
  std::uniform_real_distribution<double> height_m(-10.0, 2.0);
  std::uniform_real_distribution<double> depth_m(70.0, 200.0);
  double sum = 0.0;
  double squares = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Correspondences features;
    while (features.size() < 300) {
      const Eigen::Vector3d point(side_m(generator), height_m(generator), depth_m(generator));
      Correspondence feature;
      if (measure(kittiCamera(), point, truth, {0.1, 0.3}, generator, feature)) {
        features.push_back(feature);
      }
    }
    Eigen::Isometry3d T = truth;
    for (int i = 0; i < 10; ++i) solve(kTranslation, noise_ratio, features, T);
    const double error = T.translation().z() / 2.5 - 1.0;
    sum += error;
    squares += error * error;
  }
  const double mean = sum / kDraws;
  return {mean, std::sqrt((squares / kDraws - mean * mean) / kDraws)};
}

TEST(MotionSolverTest, NoisyDisparitiesDoNotShortenTheStep) {
  const auto [bias, standard_error] = biasOfStep(3.0);
  // Plain least squares lose the share of the noise in the mean square of the disparities, 0.3^2 /
  // 3.2^2 = 0.9 %. Second-order effects are some tenths of that.
  EXPECT_NEAR(bias, 0.0, 0.002 + 3.0 * standard_error);
  EXPECT_LT(biasOfStep(0.0).first, -0.005);
}

}  // namespace
}  // namespace rotrocc
