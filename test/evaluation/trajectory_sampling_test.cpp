#include "evaluation/trajectory_sampling.h"

#include <gtest/gtest.h>

#include "rotrocc/trajectory_error.h"

namespace rotrocc {
namespace {

/// Turns by 1 rad/s and moves by 2 m/s, with a pose every 10 ms from 0 to 90 ms.
Trajectory trajectory() {
  Trajectory poses;
  for (int i = 0; i < 10; ++i) {
    const double t = 0.01 * i;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(t, Eigen::Vector3d::UnitY()).toRotationMatrix();
    pose.translation() << 0.0, 0.0, 2.0 * t;
    poses.push_back({i * 10'000'000, pose});
  }
  return poses;
}

TEST(TrajectorySamplingTest, InterpolatesPoses) {
  const auto pose = poseAt(trajectory(), 33'000'000, 10'000'000);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation().z(), 0.066, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(pose->linear()).angle(), 0.033, 1e-12);
  EXPECT_EQ(poseAt(trajectory(), 30'000'000, 0)->matrix(), trajectory()[3].T_world_body.matrix())
      << "to the last digit, at a stamp";
}

TEST(TrajectorySamplingTest, HasNoPosesOutsideAndInGaps) {
  EXPECT_FALSE(poseAt(trajectory(), -1, 10'000'000));
  EXPECT_FALSE(poseAt(trajectory(), 90'000'001, 10'000'000));
  EXPECT_FALSE(poseAt(trajectory(), 33'000'000, 9'999'999));
  EXPECT_FALSE(poseAt({}, 0, 10'000'000));
  EXPECT_EQ(samplePoses(trajectory(), {-5, 5, 95'000'000}).size(), 1u);
}

TEST(TrajectorySamplingTest, FastTruthIsMatchedExactly) {
  Trajectory estimate(2);
  estimate[0].stamp_ns = 4'000'000;
  estimate[1].stamp_ns = 56'000'000;
  const MatchedTrajectories fast = matchByStamp(trajectory(), estimate);
  ASSERT_EQ(fast.truth.size(), 2u);
  EXPECT_EQ(fast.truth[1].stamp_ns, 56'000'000);
  EXPECT_NEAR(fast.truth[1].T_world_body.translation().z(), 0.112, 1e-12);
  // The nearest pose of a slow one, as before.
  Trajectory slow = trajectory();
  for (StampedPose& pose : slow) pose.stamp_ns *= 5;
  EXPECT_EQ(matchByStamp(slow, estimate).truth[1].stamp_ns, 50'000'000);
}

}  // namespace
}  // namespace rotrocc
