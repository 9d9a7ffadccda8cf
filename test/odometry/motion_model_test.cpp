#include "odometry/motion_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kMaxAge_s = 0.5;

Eigen::Isometry3d turnAhead() {
  return motion({0.1, 0.0, 1.2}, {0.0, 0.05, 0.01});
}

TEST(MotionModelTest, ExpectsTheLastMotionAgain) {
  MotionModel model(kMaxAge_s);
  model.update(motion({5.0, 0.0, 0.0}, {0.0, 0.0, 0.2}), 0.1);
  model.update(turnAhead(), 0.1);
  const auto predicted = model.predict(0.1);
  ASSERT_TRUE(predicted);
  EXPECT_LT((predicted->matrix() - turnAhead().matrix()).norm(), kRounding);
}

TEST(MotionModelTest, ScalesTheMotionToTheTimeThatPassed) {
  MotionModel model(kMaxAge_s);
  model.update(turnAhead(), 0.1);
  const auto twice = model.predict(0.2);
  ASSERT_TRUE(twice);
  // Constant velocity: in twice the time, the motion is applied twice.
  EXPECT_LT((twice->matrix() - (turnAhead() * turnAhead()).matrix()).norm(), kRounding);
  const auto half = model.predict(0.05);
  ASSERT_TRUE(half);
  EXPECT_LT(((*half * *half).matrix() - turnAhead().matrix()).norm(), kRounding);
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
