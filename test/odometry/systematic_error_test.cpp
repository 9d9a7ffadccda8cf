#include "odometry/systematic_error.h"

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kRounding = 1e-12;

TEST(SystematicErrorTest, IsAShareOfTheLengthAndOfTheAngle) {
  const SystematicErrorConfig config = {0.01, 0.02};
  const Matrix6d covariance =
      systematicCovariance(config, motion({0.0, 3.0, 4.0}, {0.0, 0.1, 0.0}));
  Vector6d sigma;
  sigma << 0.05, 0.05, 0.05, 0.002, 0.002, 0.002;
  EXPECT_LT((covariance - Matrix6d(sigma.cwiseAbs2().asDiagonal())).norm(), kRounding);
}

}  // namespace
}  // namespace rotrocc
