#include "motion/motion_estimator.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kPeriod_s = 0.1;
constexpr int kFeatures = 600;

/// Twice the flow noise measured on KITTI, and disparity noise at the ratio that the estimator
/// assumes.
const FeatureNoise kNoise = {0.2, 0.2 * kDisparityNoiseRatio};

/// A Gaussian error exceeds this once in 16000 cases.
constexpr double kSigmas = 4.0;

MotionEstimate estimate(const Correspondences& features,
                        const Eigen::Isometry3d& truth = turnAhead()) {
  const Eigen::Isometry3d initial = roughly(truth);
  return MotionEstimator().estimate(kittiCamera(), features, initial, kPeriod_s, initial);
}

MotionEstimate withoutRetry(const Correspondences& features) {
  const StereoCamera camera = kittiCamera();
  ReprojectionProblem problem;
  MotionEstimate found;
  TwoStageEstimator().estimate({camera, features, kDisparityNoiseRatio},
                               all(features),
                               roughly(turnAhead()),
                               problem,
                               found);
  return found;
}

Correspondences goodFeatures(unsigned seed, const Eigen::Isometry3d& truth = turnAhead()) {
  std::mt19937 generator(seed);
  return simulateFeatures(kittiCamera(), truth, kFeatures, kNoise, generator);
}

std::size_t part(double share) {
  return static_cast<std::size_t>(share * kFeatures);
}

/// Good features, of which a share has random matches.
Correspondences withRandomMatches(double share, unsigned seed) {
  Correspondences features = goodFeatures(seed);
  std::mt19937 generator(seed + 1000);
  mismatch(features, 0, part(share), 40.0, generator);
  return features;
}

/// Good features, of which a share is on a truck ahead.
Correspondences withMovingObject(double share, unsigned seed) {
  Correspondences features = goodFeatures(seed);
  std::mt19937 generator(seed + 2000);
  putOnTruck(features, part(share), turnAhead(), kNoise, generator);
  return features;
}

/// Normalized estimation error squared. It has a chi-squared distribution with 6 degrees of freedom
/// if the covariance is correct.
double nees(const MotionEstimate& estimate) {
  const Vector6d error = motionError(estimate.T_keyframe_cur, turnAhead());
  return error.dot(estimate.covariance.ldlt().solve(error));
}

double translationError(const MotionEstimate& estimate) {
  return motionError(estimate.T_keyframe_cur, turnAhead()).head<3>().norm();
}

double rotationError(const MotionEstimate& estimate) {
  return motionError(estimate.T_keyframe_cur, turnAhead()).tail<3>().norm();
}

TEST(MotionEstimatorTest, IsNotMovedByOutliers) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    for (const Correspondences& features :
         {withRandomMatches(0.3, seed), withMovingObject(0.3, seed)}) {
      const MotionEstimate found = estimate(features);
      ASSERT_TRUE(found.valid);
      const Vector6d error = motionError(found.T_keyframe_cur, turnAhead());
      for (int i = 0; i < 6; ++i) {
        EXPECT_LT(std::abs(error(i)), kSigmas * std::sqrt(found.covariance(i, i))) << seed << i;
      }
      // The covariance must not grow either: 2 mm and 0.1 mrad, as without outliers.
      const Vector6d variances = found.covariance.diagonal();
      EXPECT_LT(std::sqrt(variances.head<3>().sum()), 0.004);
      EXPECT_LT(std::sqrt(variances.tail<3>().sum()), 2e-4);
    }
  }
}

TEST(MotionEstimatorTest, IsNotMovedByATruckThatFillsMostOfThePicture) {
  double error_with = 0.0;
  double error_without = 0.0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Correspondences features = withMovingObject(0.6, seed);
    const MotionEstimate found = estimate(features);
    ASSERT_TRUE(found.valid);
    EXPECT_LT(translationError(found), 0.03) << seed;  // the truck moves by 0.3
    EXPECT_LT(rotationError(found), 1e-3) << seed;
    error_with += translationError(found);
    error_without += translationError(withoutRetry(features));
  }
  EXPECT_LT(3.0 * error_with, error_without);  // the benefit of the retry
}

TEST(MotionEstimatorTest, ThePredictionWinsWithMoreThanHalfOfTheInliersOfTheTruck) {
  // A third of the features is the limit. The truck moves by 0.3.
  EXPECT_LT(translationError(estimate(withMovingObject(0.62, 1))), 0.03);
  EXPECT_GT(translationError(estimate(withMovingObject(0.71, 1))), 0.2);
}

TEST(MotionEstimatorTest, HasATranslationStageAtRest) {
  const Eigen::Isometry3d turn = motion({0.0, 0.0, 0.0}, {0.0, 0.01, 0.0});
  EXPECT_TRUE(estimate(goodFeatures(1, turn), turn).has_translation_stage);
}

TEST(MotionEstimatorTest, FeaturesThatDetermineNoMotionGiveNone) {
  Correspondences features = goodFeatures(1);
  EXPECT_FALSE(estimate(Correspondences(50, features.front())).valid);
  for (const std::size_t size : {0u, 1u, 2u}) {
    features.resize(size);
    const MotionEstimate found = estimate(features);
    EXPECT_FALSE(found.valid) << size;
    EXPECT_EQ(found.rotation_inliers.size(), size);
    EXPECT_EQ(found.translation_inliers.size(), size);
  }
}

/// Mean of nees() over many samples of the noise.
double meanNees(Correspondences (*make)(unsigned seed)) {
  constexpr int kDraws = 300;
  double sum = 0.0;
  for (unsigned seed = 0; seed < kDraws; ++seed) sum += nees(estimate(make(seed)));
  return sum / kDraws;
}

/// The mean of 300 chi-squared values with 6 degrees of freedom is 6 +- 0.2. In addition, depth is
/// not a linear function of a disparity of 4 +- 0.9 px, and the scatter over the cells can only
/// increase the covariance. Measured: 4.6 to 6.8.
TEST(MotionEstimatorTest, TheCovarianceIsThatOfTheErrors) {
  const auto good = [](unsigned seed) { return goodFeatures(seed); };
  const auto random = [](unsigned seed) { return withRandomMatches(0.3, seed); };
  const auto moving = [](unsigned seed) { return withMovingObject(0.3, seed); };
  for (const double mean : {meanNees(good), meanNees(random), meanNees(moving)}) {
    EXPECT_GT(mean, 4.2);
    EXPECT_LT(mean, 8.0);
  }
}

/// The median of 600 lengths has a standard deviation of 2.9 %.
TEST(MotionEstimatorTest, TheFlowNoiseIsThatOfTheFeatures) {
  for (const bool has_outliers : {false, true}) {
    const double noise_px =
        estimate(has_outliers ? withRandomMatches(0.3, 1) : goodFeatures(1)).flow_noise_px;
    EXPECT_NEAR(noise_px, kNoise.flow_px, kSigmas * 0.029 * kNoise.flow_px) << has_outliers;
  }
}

}  // namespace
}  // namespace rotrocc
