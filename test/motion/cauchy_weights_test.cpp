#include "motion/cauchy_weights.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

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
