#include "motion/cauchy_weights.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// Lengths of vectors of two Gaussian numbers of this standard deviation, one of them exactly
/// `last_px` long.
std::vector<double> gaussianErrors(double sigma_px, double last_px) {
  std::mt19937 generator(1);
  std::normal_distribution<double> number(0.0, sigma_px);
  std::vector<double> errors_px(10000);
  for (double& error_px : errors_px) error_px = std::hypot(number(generator), number(generator));
  errors_px.push_back(last_px);
  return errors_px;
}

TEST(CauchyWeightsTest, AreAHalfAtTheFactorTimesTheStandardDeviation) {
  for (const double sigma_px : {0.1, 2.0}) {
    CauchyWeights weights(3.0);
    weights.update(gaussianErrors(sigma_px, 3.0 * sigma_px));
    // The median of 10000 has a standard deviation of 0.8 %, which is half of that in the weight.
    EXPECT_NEAR(weights[10000], 0.5, 0.02);
  }
}

TEST(CauchyWeightsTest, FallWithTheError) {
  CauchyWeights weights(2.0);
  weights.update({0.3, 0.0, 0.1, 10.0, 0.2});
  EXPECT_EQ(weights[1], 1.0);
  EXPECT_LT(weights[2], weights[1]);
  EXPECT_LT(weights[4], weights[2]);
  EXPECT_LT(weights[0], weights[4]);
  EXPECT_LT(weights[3], 0.01);
  EXPECT_GT(weights[3], 0.0);
}

TEST(CauchyWeightsTest, AreEqualWithoutAFactorOrAnError) {
  CauchyWeights equal(0.0);
  equal.update({0.3, 5.0, 0.1});
  EXPECT_EQ(equal[1], 1.0);
  CauchyWeights exact(2.0);
  exact.update({0.0, 0.0, 0.0, 5.0});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(exact[i], 1.0);
  exact.update({});  // no feature: nothing happens
}

TEST(CauchyWeightsTest, VarianceIsThatOfTheResidualsWithAndWithoutWeights) {
  std::mt19937 generator(2);
  std::normal_distribution<double> number(0.0, 0.3);
  Eigen::VectorXd residuals_px(20000);
  for (Eigen::Index i = 0; i < residuals_px.size(); ++i) residuals_px[i] = number(generator);
  for (const double factor : {0.0, 100.0}) {
    CauchyWeights weights(factor);
    std::vector<double> errors_px;
    for (Eigen::Index i = 0; i < residuals_px.size(); i += 2) {
      errors_px.push_back(residuals_px.segment<2>(i).norm());
    }
    weights.update(errors_px);
    // The standard deviation of the variance of 20000 is 1 %; with this factor weights are next
    // to 1.
    EXPECT_NEAR(weights.variance(residuals_px, 6), 0.09, 0.04 * 0.09);
    EXPECT_EQ(weights.variance(residuals_px, 20000), 0.0);
  }
}

}  // namespace
}  // namespace rotrocc
