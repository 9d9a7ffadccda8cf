#include "odometry/motion_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kMaxAge_s = 0.5;

TEST(MotionModelTest, ScalesTheLastMotionToTheTimeThatPassed) {
  MotionModel model(kMaxAge_s);
  model.update(motion({5.0, 0.0, 0.0}, {0.0, 0.0, 0.2}), 0.1);
  model.update(turnAhead(), 0.1);
  EXPECT_LT((model.predict(0.1).value().matrix() - turnAhead().matrix()).norm(), kRounding);
  // Constant velocity: in twice the time, the motion is applied twice.
  const Eigen::Isometry3d twice = turnAhead() * turnAhead();
  EXPECT_LT((model.predict(0.2).value().matrix() - twice.matrix()).norm(), kRounding);
}

TEST(MotionModelTest, TakesAMeasuredRotationAndTurnsItsVelocity) {
  MotionModel model(kMaxAge_s);
  model.update(motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}), 0.1);
  const Eigen::Matrix3d turn = expRotation({0.0, 0.4, 0.0});
  const auto predicted = model.predict(0.2, turn);
  ASSERT_TRUE(predicted);
  EXPECT_LT((predicted->linear() - turn).norm(), kRounding);
  // An arc of 2 m: the chord is at half of the angle.
  const Eigen::Vector3d chord =
      2.0 * std::sin(0.2) / 0.2 * Eigen::Vector3d(std::sin(0.2), 0.0, std::cos(0.2));
  EXPECT_LT((predicted->translation() - chord).norm(), kRounding);
}

TEST(MotionModelTest, ExpectsNothingAtFirstOrAfterAGapOrAReset) {
  MotionModel model(kMaxAge_s);
  EXPECT_FALSE(model.predict(0.1));
  model.update(turnAhead(), 0.1);
  EXPECT_TRUE(model.predict(0.5));
  EXPECT_FALSE(model.predict(0.51));
  model.setMaxAge(0.3);
  EXPECT_TRUE(model.predict(0.3));
  EXPECT_FALSE(model.predict(0.31));
  model.reset();
  EXPECT_FALSE(model.predict(0.1));
}

}  // namespace
}  // namespace rotrocc
