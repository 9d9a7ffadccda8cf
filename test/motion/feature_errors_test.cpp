#include "motion/feature_errors.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kRounding_px = 1e-9;

Correspondences features(const Eigen::Isometry3d& T_keyframe_cur) {
  std::mt19937 generator(1);
  return simulateFeatures(kittiCamera(), T_keyframe_cur, 100, {}, generator);
}

std::vector<double> decoupled(const Correspondences& features, const Eigen::Isometry3d& T) {
  const StereoCamera camera = kittiCamera();
  std::vector<double> lengths_px;
  decoupledFlow({camera, features, 0.0}, T, lengths_px);
  return lengths_px;
}

TEST(FlowDecouplingTest, IsTheDistanceToTheRotatedRay) {
  const Eigen::Isometry3d T = motion({0.2, -0.05, 1.4}, {0.01, 0.06, -0.02});
  const StereoCamera camera = kittiCamera();
  const Correspondences moved = features(T);
  const std::vector<double> lengths_px = decoupled(moved, T);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    // Eq. 28 needs no depth: it uses pi(R x) of the ray.
    const Eigen::Vector3d ray = T.linear() * camera.ray(moved[i].cur_px);
    EXPECT_NEAR(lengths_px[i], (moved[i].keyframe_px - camera.project(ray)).norm(), kRounding_px);
  }
}

TEST(FlowDecouplingTest, StaysFiniteForPointsTurnedBehindTheCamera) {
  const Eigen::Isometry3d T = motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  for (const double length_px : decoupled(features(T), motion({0.0, 0.0, 0.0}, {0.0, 3.0, 0.0}))) {
    EXPECT_TRUE(std::isfinite(length_px));
  }
}

const std::vector<double> kErrors = {1.0, 10.0, 2.0, 9.0, 3.0, 8.0, 4.0, 7.0, 5.0, 6.0};
const FeatureSet kAll(10, 1);

std::vector<double> ofSet(const std::vector<double>& errors, const FeatureSet& set) {
  std::vector<double> selected;
  select(errors, set, selected);
  return selected;
}

double limitOf(double limit, double drop_share, const FeatureSet& set) {
  std::vector<double> errors = ofSet(kErrors, set);
  return fixedLimit(limit, drop_share, errors);
}

TEST(OutlierRejectionTest, DropsNoMoreThanAShareAtOnce) {
  // b = 20 % of 10: the 2nd highest error; the limit is far below (Eq. 26, 30).
  EXPECT_DOUBLE_EQ(limitOf(0.5, 0.2, kAll), 9.0);
  // A share that is not a whole number of features is rounded up, so at least one is dropped.
  EXPECT_DOUBLE_EQ(limitOf(0.5, 0.25, kAll), 8.0);
  EXPECT_DOUBLE_EQ(limitOf(0.5, 0.001, kAll), 10.0);
  EXPECT_DOUBLE_EQ(limitOf(0.5, 1.0, kAll), 1.0);
  EXPECT_DOUBLE_EQ(limitOf(9.5, 0.2, kAll), 9.5) << "the fixed limit ends it";
}

TEST(OutlierRejectionTest, TakesTheErrorsOfTheSetOnly) {
  FeatureSet set = kAll;
  set[1] = set[3] = 0;  // 10 and 9
  EXPECT_DOUBLE_EQ(limitOf(0.5, 0.1, set), 8.0);
}

TEST(OutlierRejectionTest, AnEmptySetHasNoThreshold) {
  const FeatureSet none(10, 0);
  EXPECT_TRUE(std::isinf(limitOf(0.5, 0.2, none)));
}

TEST(OutlierRejectionTest, KeepsWhatIsBelowTheThreshold) {
  FeatureSet set = {1, 1, 0, 0};
  EXPECT_TRUE(keepBelow({0.5, 1.0, 0.7, 2.0}, 1.0, set));
  EXPECT_EQ(set, (FeatureSet{1, 0, 1, 0}));  // dropped features may come back
  EXPECT_FALSE(keepBelow({0.5, 1.0, 0.7, 2.0}, 1.0, set));
  EXPECT_TRUE(keepBelow({0.5, std::nan(""), std::nan(""), 2.0}, 1.0, set));
  EXPECT_EQ(set, (FeatureSet{1, 0, 0, 0}));
}

/// Lengths of vectors of two Gaussian numbers with this standard deviation. One of them has exactly
/// the length `last_px`.
std::vector<double> gaussianErrors(double sigma_px, double last_px) {
  std::mt19937 generator(1);
  std::normal_distribution<double> number(0.0, sigma_px);
  std::vector<double> errors_px(10000);
  for (double& error_px : errors_px) error_px = std::hypot(number(generator), number(generator));
  errors_px.push_back(last_px);
  return errors_px;
}

std::vector<double> weightsOf(double factor, const std::vector<double>& errors_px) {
  std::vector<double> weights;
  cauchyWeights(factor, errors_px, weights);
  return weights;
}

TEST(CauchyWeightsTest, AreAHalfAtTheFactorTimesTheStandardDeviation) {
  for (const double sigma_px : {0.1, 2.0}) {
    const auto weights = weightsOf(3.0, gaussianErrors(sigma_px, 3.0 * sigma_px));
    // The median of 10000 values has a standard deviation of 0.8 %. That of the weight is half of
    // it.
    EXPECT_NEAR(weights[10000], 0.5, 0.02);
  }
}

TEST(CauchyWeightsTest, AreEqualWithoutAFactorOrAnError) {
  const std::vector<double> ones(4, 1.0);
  EXPECT_EQ(weightsOf(0.0, {0.3, 5.0, 0.1, 1.0}), ones);
  EXPECT_EQ(weightsOf(2.0, {0.0, 0.0, 0.0, 5.0}), ones);
  EXPECT_TRUE(weightsOf(2.0, {}).empty());
}

TEST(WeightedVarianceTest, IsThatOfTheResidualsWithAndWithoutWeights) {
  const std::vector<double> errors_px = gaussianErrors(0.3, 0.3);
  for (const double factor : {0.0, 100.0}) {
    const auto weights = weightsOf(factor, errors_px);
    WeightedVariance variance;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      variance.add(weights[i], errors_px[i] * errors_px[i]);
    }
    // The variance of 20002 values has a standard deviation of 1 %. With this factor, all weights
    // are close to 1.
    EXPECT_NEAR(variance.value(6), 0.09, 0.04 * 0.09);
    EXPECT_EQ(variance.value(20002), 0.0);
  }
}

}  // namespace
}  // namespace rotrocc
