#include "rotrocc/pose_accumulator.h"

#include <cmath>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

Eigen::Isometry3d step() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(0.1, -0.02, 1.3);
  T.rotate(Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.1, 1.0, -0.2).normalized()));
  return T;
}

TEST(PoseAccumulatorTest, LaterMotionsAreInLaterFrames) {
  // A quarter turn about y, then forward: the step is along the x axis of the first frame.
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.rotate(Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitY()));
  Eigen::Isometry3d forward = Eigen::Isometry3d::Identity();
  forward.translation().z() = 2.0;
  PoseAccumulator pose;
  pose.add(turn);
  pose.add(forward);
  EXPECT_TRUE(pose.T_first_cur().translation().isApprox(Eigen::Vector3d(2.0, 0.0, 0.0), 1e-15));
}

TEST(PoseAccumulatorTest, RotationStaysARotation) {
  PoseAccumulator pose;
  // A day at 10 Hz. Without normalization, errors of 1e-16 per step accumulate to 1e-11 or more.
  for (int i = 0; i < 864'000; ++i) pose.add(step());
  const Eigen::Matrix3d R = pose.T_first_cur().linear();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

}  // namespace
}  // namespace rotrocc
