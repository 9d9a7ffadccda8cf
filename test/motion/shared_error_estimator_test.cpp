#include "motion/shared_error_estimator.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "motion/motion_estimator.h"
#include "motion/reprojection_problem.h"
#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr double kFlow_px = 0.1;
constexpr int kPairs = 40;

const MotionEstimator::Prediction kPrediction = {turnAhead(), kPeriod_s};

/// Features of a pair. Their disparities have their own noise, an error common to each cell of the
/// image, and a parabola over the rows, both with a standard deviation of `ratio` times the flow
/// noise.
Correspondences pairWith(double ratio, unsigned seed) {
  const StereoCamera camera = kittiCamera();
  std::mt19937 generator(seed);
  Correspondences features = simulateFeatures(
      camera, turnAhead(), 600, {kFlow_px, kDisparityNoiseRatio * kFlow_px}, generator);
  std::normal_distribution<double> error_px(0.0, ratio * kFlow_px);
  std::vector<double> of_cell(SharedErrorGrid::kCells);
  for (double& error : of_cell) error = error_px(generator);
  const double at_border = error_px(generator);
  const SharedErrorGrid grid(camera);
  for (Correspondence& feature : features) {
    const double y = 2.0 * feature.keyframe_px.y() / camera.height - 1.0;
    feature.disparity_px += of_cell[grid.cell(feature.keyframe_px)] + at_border * y * y;
  }
  triangulate(camera, features);
  return features;
}

double estimatedRatio(double ratio) {
  SharedErrorEstimator estimator;
  for (unsigned pair = 0; pair < kPairs; ++pair) {
    const Correspondences features = pairWith(ratio, pair);
    MotionEstimator motion_estimator({});
    const auto& estimate = motion_estimator.estimate(
        kittiCamera(), features, turnAhead(), kPeriod_s, kPrediction, estimator.ratio());
    estimator.advance();
    estimator.observe(kittiCamera(), features, estimate.rotation_inliers, estimate.T_keyframe_cur);
  }
  return estimator.ratio();
}

/// 40 pairs of about 30 informative cells give a standard deviation of the ratio of 3 %. Large
/// errors are underestimated, because their features look like outliers: measured 3.7 instead of 5.
TEST(SharedErrorEstimatorTest, FindsTheErrorThatNeighboursShare) {
  EXPECT_LT(estimatedRatio(0.0), 0.7);
  EXPECT_NEAR(estimatedRatio(2.0), 2.0, 0.4);
  EXPECT_NEAR(estimatedRatio(5.0), 4.0, 0.8);
}

/// 100 s at rest, with new keyframes or with one.
TEST(SharedErrorEstimatorTest, RestSaysNothing) {
  for (const bool one_keyframe : {false, true}) {
    SharedErrorEstimator estimator;
    const Correspondences moving = pairWith(2.0, 1);
    estimator.observe(kittiCamera(), moving, all(moving), turnAhead());
    const double before = estimator.ratio();
    std::mt19937 generator(1);
    const Eigen::Isometry3d none = Eigen::Isometry3d::Identity();
    estimator.advance();
    for (int pair = 0; pair < 1000; ++pair) {
      const Correspondences resting =
          simulateFeatures(kittiCamera(), none, 100, {kFlow_px, 4.0 * kFlow_px}, generator);
      if (!one_keyframe) estimator.advance();
      estimator.observe(kittiCamera(), resting, all(resting), none);
    }
    EXPECT_NEAR(estimator.ratio(), before, 0.05 * before) << one_keyframe;
  }
}

TEST(SharedErrorEstimatorTest, MotionsOfOneKeyframeCountOnce) {
  SharedErrorEstimator once;
  SharedErrorEstimator often;
  const Correspondences features = pairWith(4.0, 1);
  once.observe(kittiCamera(), features, all(features), turnAhead());
  for (int i = 0; i < 50; ++i) often.observe(kittiCamera(), features, all(features), turnAhead());
  // The weights of the cells depend on the estimate, which the first observation changes.
  EXPECT_NEAR(often.ratio(), once.ratio(), 0.1 * once.ratio());
}

/// Errors of cells with many features pull the translation. Knowing of them reduces its variance:
/// measured to 0.50 times. The ratio of two variances of 40 pairs has a standard deviation of 20 %.
TEST(SharedErrorEstimatorTest, MakesTheTranslationMoreAccurate) {
  constexpr double kRatio = 5.0;
  double with = 0.0;
  double without = 0.0;
  for (unsigned pair = 0; pair < kPairs; ++pair) {
    const Correspondences features = pairWith(kRatio, pair);
    const auto error2 = [&](double shared_ratio) {
      MotionEstimator estimator({});
      const auto& estimate = estimator.estimate(
          kittiCamera(), features, turnAhead(), kPeriod_s, kPrediction, shared_ratio);
      return motionError(estimate.T_keyframe_cur, turnAhead()).head<3>().squaredNorm();
    };
    with += error2(kRatio);
    without += error2(0.0);
  }
  EXPECT_LT(with, 0.75 * without);
}

}  // namespace
}  // namespace rotrocc
