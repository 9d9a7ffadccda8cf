#include "rotrocc/rigid_motion.h"

#include <cmath>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr double kRounding = 1e-12;  // of some dozen operations on values near 1

const Eigen::Vector3d kAxis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();

TEST(RigidMotionTest, RotatesByTheRightHand) {
  const Eigen::Vector3d turned = expRotation({0.0, 0.0, M_PI / 2.0}) * Eigen::Vector3d::UnitX();
  EXPECT_LT((turned - Eigen::Vector3d::UnitY()).norm(), kRounding);
}

TEST(RigidMotionTest, LogIsTheInverseOfExp) {
  for (const double angle : {0.0, 1e-12, 1e-6, 9e-5, 1.1e-4, 0.3, 2.0, 3.14}) {
    const Eigen::Vector3d v = angle * kAxis;
    EXPECT_LT((logRotation(expRotation(v)) - v).norm(), 1e-9) << angle;
    Vector6d twist;
    twist << 1.0, -2.0, 3.0, v;
    EXPECT_LT((logMotion(expMotion(twist)) - twist).norm(), 1e-8) << angle;
  }
}

TEST(RigidMotionTest, AnglesAboveHalfATurnAreTakenTheShortWay) {
  EXPECT_LT((logRotation(expRotation(4.0 * kAxis)) + (2.0 * M_PI - 4.0) * kAxis).norm(), 1e-9);
}

TEST(RigidMotionTest, LeftJacobianIsTheDerivativeOfExp) {
  for (const double angle : {0.0, 1e-5, 9.9e-5, 1.01e-4, 0.4, 2.5}) {
    const Eigen::Vector3d v = angle * kAxis;
    Eigen::Matrix3d numeric;
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      numeric.col(i) =
          logRotation(expRotation(v + step) * expRotation(v - step).transpose()) / (2.0 * kStep);
    }
    // Errors of central differences: rounding 1e-16 / step, and the square of the step.
    EXPECT_LT((leftJacobian(v) - numeric).norm(), 1e-8) << angle;
  }
}

TEST(RigidMotionTest, AConstantTwistMovesAlongAnArc) {
  // A quarter circle to the left with a radius of 2 m; body axes x forward and y left.
  Vector6d twist;
  twist << M_PI, 0.0, 0.0, 0.0, 0.0, M_PI / 2.0;
  const Eigen::Isometry3d T = expMotion(twist);
  EXPECT_LT((T.translation() - Eigen::Vector3d(2.0, 2.0, 0.0)).norm(), kRounding);
  EXPECT_LT((T.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), kRounding);
}

}  // namespace
}  // namespace rotrocc
