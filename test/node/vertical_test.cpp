#include "node/gyro/vertical.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr std::int64_t kPeriod_ns = 5'000'000;
const Eigen::Vector3d kGravity(1.0, -2.0, std::sqrt(9.81 * 9.81 - 5.0));

/// A second of an IMU that turns and is pushed to and fro by these amplitudes.
std::int64_t shake(double rate_rps,
                   double push_mps2,
                   Vertical& vertical,
                   const Eigen::Vector3d& gravity_mps2 = kGravity,
                   int samples = 200) {
  std::int64_t stamp_ns = 7'000'000'000;
  for (int i = 0; i < samples; ++i) {
    const double way = std::sin(0.7 * i);
    vertical.add({stamp_ns += kPeriod_ns, {0.03, 0.0, rate_rps * way}},
                 gravity_mps2 + push_mps2 * way * Eigen::Vector3d::UnitX());
  }
  return stamp_ns;
}

TEST(VerticalTest, IsThatOfGravityAtRestAlsoIfAnEngineRuns) {
  Vertical vertical;
  const std::int64_t stamp_ns = shake(0.05, 0.5, vertical);
  EXPECT_TRUE(vertical.isComplete());
  EXPECT_EQ(vertical.whyUnknown(stamp_ns), std::nullopt);
  EXPECT_LT((vertical.up() - kGravity.normalized()).norm(), 1e-3);
  EXPECT_NEAR(vertical.up().norm(), 1.0, 1e-12);
}

TEST(VerticalTest, SaysWhyItIsNotKnown) {
  const auto why = [](double rate_rps,
                      double push_mps2,
                      const Eigen::Vector3d& gravity_mps2 = kGravity,
                      int samples = 200,
                      std::int64_t later_ns = 0) {
    Vertical vertical;
    const std::int64_t stamp_ns = shake(rate_rps, push_mps2, vertical, gravity_mps2, samples);
    return vertical.whyUnknown(stamp_ns + later_ns).value_or("");
  };
  EXPECT_EQ(Vertical().whyUnknown(0), "there are no accelerations of 1 s");
  EXPECT_EQ(why(0.0, 0.0, kGravity, 150), "there are no accelerations of 1 s");
  EXPECT_EQ(
      why(0.5, 0.0).find("the robot is not at rest: angular velocities scatter by 0.353 rad/s "
                         "(at rest up to 0.05), accelerations by "),
      0u);
  EXPECT_NE(why(0.0, 2.0).find("accelerations by 1.41 m/s^2 (0.5)"), std::string::npos);
  EXPECT_NE(why(0.0, 0.0, Eigen::Vector3d::UnitZ()).find("is 1 m/s^2"), std::string::npos);
  EXPECT_EQ(why(0.0, 0.0, kGravity, 200, 3'000'000'000),
            "the newest acceleration and the image are 3 s apart");
}

TEST(VerticalTest, IsThatOfTheLastSecond) {
  Vertical vertical;
  shake(2.0, 5.0, vertical, -kGravity);
  for (int i = 0; i < 5; ++i) {
    vertical.add({8'000'000'000, {}}, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  }
  const std::int64_t stamp_ns = shake(0.0, 0.0, vertical);  // time jumps back
  EXPECT_EQ(vertical.whyUnknown(stamp_ns), std::nullopt);
  EXPECT_TRUE(vertical.up().isApprox(kGravity.normalized(), 1e-9));
}

}  // namespace
}  // namespace rotrocc
