#include "tools/frame_alignment.h"

#include <cmath>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// A body on a winding way over hills.
Trajectory drive() {
  Trajectory poses;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (std::int64_t i = 0; i < 200; ++i) {
    poses.push_back({i * 100'000'000, T});
    T.translate(Eigen::Vector3d(0.5, 0.0, 0.0));
    T.rotate(Eigen::AngleAxisd(0.05 * std::sin(0.05 * static_cast<double>(i)),
                               Eigen::Vector3d::UnitZ()));
    T.rotate(Eigen::AngleAxisd(0.01 * std::cos(0.08 * static_cast<double>(i)),
                               Eigen::Vector3d::UnitY()));
  }
  return poses;
}

/// The poses of what is rigidly connected to a body, relative to its own first one, by an odometry
/// that is 1 % too long.
Trajectory ofCamera(const Trajectory& body, const Eigen::Isometry3d& T_body_camera) {
  Trajectory poses = body;
  for (StampedPose& pose : poses) {
    pose.T_world_body = T_body_camera.inverse() * pose.T_world_body * T_body_camera;
    pose.T_world_body.translation() *= 1.01;
  }
  return poses;
}

/// One that looks 20 degrees down from a mast, ahead of the base.
Eigen::Isometry3d mast() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.rotate(Eigen::AngleAxisd(-M_PI / 9.0, Eigen::Vector3d::UnitX()));
  T.translation() = Eigen::Vector3d(1.0, 0.2, 1.5);
  return T;
}

TEST(FrameAlignmentTest, FindsWhereTheBaseIsOnTheCamera) {
  const Trajectory truth = drive();
  const FrameAlignment found = alignFrames({truth, ofCamera(truth, mast())});
  EXPECT_TRUE(found.isNeeded());
  const Eigen::Isometry3d off = mast() * found.T_estimate_truth;
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.01);
  EXPECT_LT(off.translation().norm(), 0.2) << "1 % of the way is not explained by it";
  EXPECT_GT(found.error_before, 0.5);
  EXPECT_LT(found.error_after, 0.015);

  const MatchedTrajectories as_base = {truth, ofCamera(truth, Eigen::Isometry3d::Identity())};
  const MatchedTrajectories aligned = {truth, withFrame(ofCamera(truth, mast()), found)};
  const SegmentConfig segments = fittingSegments(pathLengths(truth).back());
  const double expected = meanError(segmentErrors(as_base, segments)).translation;
  EXPECT_NEAR(meanError(segmentErrors(aligned, segments)).translation, expected, 0.15 * expected);
}

TEST(FrameAlignmentTest, LeavesPosesOfOneBodyAlone) {
  const Trajectory truth = drive();
  const FrameAlignment found = alignFrames({truth, ofCamera(truth, Eigen::Isometry3d::Identity())});
  EXPECT_FALSE(found.isNeeded());
  EXPECT_LT(Eigen::AngleAxisd(found.T_estimate_truth.linear()).angle(), 1e-3);
  EXPECT_LT(found.T_estimate_truth.translation().norm(), 0.2);
  Trajectory still = truth;
  for (StampedPose& pose : still) pose.T_world_body.setIdentity();
  EXPECT_FALSE(alignFrames({still, truth}).isNeeded());
}

}  // namespace
}  // namespace rotrocc
