#include "rotrocc/trajectory_error.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr std::int64_t kPeriod_ns = 100'000'000;

/// A drive with a constant step and a constant turn about the camera's y axis, at 10 Hz.
Trajectory drive(int count, double step_m, double turn_rad = 0.0) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation().z() = step_m;
  motion.rotate(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()));
  Trajectory trajectory(1);
  while (static_cast<int>(trajectory.size()) < count) {
    const StampedPose& last = trajectory.back();
    trajectory.push_back({last.stamp_ns + kPeriod_ns, last.T_world_body * motion});
  }
  return trajectory;
}

Trajectory shiftedInTime(Trajectory trajectory, std::int64_t shift_ns) {
  for (StampedPose& pose : trajectory) pose.stamp_ns += shift_ns;
  return trajectory;
}

TEST(SegmentErrorsTest, ScaleErrorIsTheTranslationError) {
  // A segment of 100 m ends with the 77th step of 1.3 m, at 100.1 m.
  const MatchedTrajectories matched{drive(200, 1.3), drive(200, 1.3 * 1.01)};
  const auto errors = segmentErrors(matched, {{100.0}, 10});
  // From poses 0, 10 ... 120; after that, less than 100 m remain.
  ASSERT_EQ(errors.size(), 13u);
  for (const SegmentError& error : errors) {
    EXPECT_NEAR(error.translation, 0.01 * 100.1 / 100.0, 1e-12);
    EXPECT_NEAR(error.rotation_rad_per_m, 0.0, 1e-12);
    EXPECT_NEAR(error.speed_mps, 100.0 / 7.7, 1e-9);
  }
  EXPECT_EQ(errors[1].first_pose, 10);
}

TEST(SegmentErrorsTest, NoneFitIntoAShortPath) {
  const Trajectory drive_99m = drive(100, 1.0);
  EXPECT_TRUE(segmentErrors({drive_99m, drive_99m}).empty());
  EXPECT_TRUE(segmentErrors({{}, {}}).empty());
  EXPECT_EQ(meanError({}).segments, 0);
}

TEST(SegmentErrorsTest, ShortPathsGetShortSegments) {
  EXPECT_EQ(fittingSegments(3000.0).lengths_m, SegmentConfig().lengths_m);
  EXPECT_EQ(fittingSegments(200.0).step, SegmentConfig().step);
  const SegmentConfig clip = fittingSegments(60.0);
  EXPECT_EQ(clip.lengths_m.back(), 40.0);
  EXPECT_EQ(clip.step, 1);
}

TEST(SegmentErrorsTest, RejectBadInput) {
  const Trajectory trajectory = drive(3, 1.0);
  const MatchedTrajectories matched{trajectory, trajectory};
  expectError<std::invalid_argument>([&] { segmentErrors(matched, {{0.0}, 1}); }, "length 0 m");
  expectError<std::invalid_argument>([&] { segmentErrors(matched, {{NAN}, 1}); }, "nan");
  expectError<std::invalid_argument>([&] { segmentErrors(matched, {{1.0}, 0}); }, "step 0");
  const MatchedTrajectories unmatched{trajectory, drive(2, 1.0)};
  expectError<std::invalid_argument>([&] { segmentErrors(unmatched); }, "3 poses, the estimate 2");
  expectError<std::invalid_argument>([&] { stepErrors(unmatched); }, "3 poses, the estimate 2");
  expectError<std::invalid_argument>([&] { finalDrift(unmatched); }, "3 poses, the estimate 2");
  MatchedTrajectories still = matched;
  for (StampedPose& pose : still.truth) pose.stamp_ns = 7;
  expectError<std::invalid_argument>(
      [&] {
        segmentErrors(still, {{1.0}, 1});
      },
      "7 ns comes after 7 ns");
}

TEST(MeanErrorTest, SpeedsCountForBothNeighbors) {
  // 4 m/s is exactly 2 m/s away from the neighbors 2 and 6, so it counts only for 4.
  const auto by_speed = meanErrorBySpeed({{0, 1.0, 0.5, 0.1, 0.0},
                                          {0, 1.0, 4.0, 0.2, 0.0},
                                          {0, 1.0, 4.5, 0.4, 0.0},
                                          {0, 1.0, 31.0, 0.8, 0.0}});
  ASSERT_EQ(by_speed.size(), 5u);
  const double bins[] = {2.0, 4.0, 6.0, 30.0, 32.0};
  const double translations[] = {0.1, 0.3, 0.4, 0.8, 0.8};
  for (std::size_t i = 0; i < by_speed.size(); ++i) {
    EXPECT_EQ(by_speed[i].bin, bins[i]);
    EXPECT_NEAR(by_speed[i].translation, translations[i], 1e-15);
  }
}

TEST(StepErrorsTest, DescribeTheMotionsFromPoseToPose) {
  const Trajectory truth = drive(101, 1.0);
  Trajectory estimate = truth;
  for (std::size_t i = 50; i < estimate.size(); ++i) {
    estimate[i].T_world_body.translation().z() += 3.0;  // one wrong step of 100
  }
  const std::vector<StepError> steps = stepErrors({truth, estimate});
  ASSERT_EQ(steps.size(), 100u);
  EXPECT_NEAR(steps[48].translation_m, 0.0, 1e-12);
  EXPECT_NEAR(steps[49].translation_m, 3.0, 1e-12);
  const StepSummary errors = summarize(steps);
  EXPECT_NEAR(errors.translation_m.mean, 0.03, 1e-12);
  EXPECT_NEAR(errors.translation_m.rms, 0.3, 1e-12);
  EXPECT_NEAR(errors.translation_m.p95, 0.0, 1e-12);
  EXPECT_NEAR(errors.translation_m.max, 3.0, 1e-12);
  EXPECT_NEAR(errors.rotation_rad.max, 0.0, 1e-12);

  const StepSummary turning = summarize(stepErrors({drive(20, 1.0), drive(20, 1.0, 1e-6)}));
  EXPECT_NEAR(turning.rotation_rad.mean, 1e-6, 1e-12) << "tiny angles must survive";
  EXPECT_NEAR(turning.rotation_rad.p95, 1e-6, 1e-12);
  EXPECT_EQ(summarize(stepErrors({{}, {}})).translation_m.max, 0.0);
  EXPECT_EQ(finalDrift({{}, {}}).translation_m, 0.0);
}

TEST(MatchByStampTest, TakesTheNearestWithinTheTolerance) {
  const Trajectory truth = drive(5, 1.0);
  const auto near = matchByStamp(truth, shiftedInTime(drive(4, 1.0), kPeriod_ns + 9'000'000));
  ASSERT_EQ(near.truth.size(), 4u);
  EXPECT_EQ(near.truth.front().stamp_ns, kPeriod_ns);
  EXPECT_EQ(near.estimate.front().stamp_ns, kPeriod_ns + 9'000'000);
  EXPECT_TRUE(matchByStamp(truth, shiftedInTime(drive(4, 1.0), 11'000'000)).truth.empty());
  EXPECT_TRUE(matchByStamp({}, truth).truth.empty());
  EXPECT_TRUE(matchByStamp(truth, {}).truth.empty());
}

TEST(MatchByStampTest, UsesEachPoseOnce) {
  Trajectory dense = drive(3, 1.0);  // stamps 0, 4, 8 ms: all within 10 ms of the truth's at 3 ms
  for (std::size_t i = 0; i < dense.size(); ++i)
    dense[i].stamp_ns = 4'000'000 * static_cast<int>(i);
  const auto matched = matchByStamp(shiftedInTime(drive(2, 1.0), 3'000'000), dense);
  ASSERT_EQ(matched.estimate.size(), 1u);
  EXPECT_EQ(matched.estimate[0].stamp_ns, 4'000'000);
}

TEST(MatchByStampTest, InterpolatesATruthOf50HzOrMore) {
  Trajectory truth = drive(10, 0.02);
  for (StampedPose& pose : truth) pose.stamp_ns /= 10;
  Trajectory estimate(2);
  estimate[0].stamp_ns = 4'000'000;
  estimate[1].stamp_ns = 56'000'000;
  const MatchedTrajectories fast = matchByStamp(truth, estimate);
  ASSERT_EQ(fast.truth.size(), 2u);
  EXPECT_EQ(fast.truth[1].stamp_ns, 56'000'000);
  EXPECT_NEAR(fast.truth[1].T_world_body.translation().z(), 0.112, 1e-12);
  for (StampedPose& pose : truth) pose.stamp_ns *= 5;
  EXPECT_EQ(matchByStamp(truth, estimate).truth[1].stamp_ns, 50'000'000) << "the nearest pose";
}

/// The errors of two published estimates of KITTI 00, as computed by the devkit.
TEST(TrajectoryErrorOnKittiTest, AgreesWithTheDevkit) {
  const char* kitti = std::getenv("ROTROCC_KITTI_DIR");
  const auto poses = std::filesystem::path(kitti == nullptr ? "" : kitti) / "../kitti_poses";
  if (kitti == nullptr || !std::filesystem::exists(poses)) {
    GTEST_SKIP() << "needs $ROTROCC_KITTI_DIR/../kitti_poses with gt/00.txt and the estimates "
                    "est/evo_KITTI_00_ORB.txt and est/evo_KITTI_00_SPTAM.txt";
  }
  const Trajectory truth = readTrajectory((poses / "gt/00.txt").string());
  const auto evaluate = [&](const char* name) {
    return meanError(
        segmentErrors(matchByIndex(truth, readTrajectory((poses / "est" / name).string()))));
  };
  // Half a unit of the last published digit.
  const MeanError orb = evaluate("evo_KITTI_00_ORB.txt");
  EXPECT_NEAR(100.0 * orb.translation, 0.700, 0.0005);
  EXPECT_NEAR(orb.rotation_rad_per_m / kDegree, 0.00253, 0.000005);
  const MeanError sptam = evaluate("evo_KITTI_00_SPTAM.txt");
  EXPECT_NEAR(100.0 * sptam.translation, 1.487, 0.0005);
  EXPECT_NEAR(sptam.rotation_rad_per_m / kDegree, 0.00558, 0.000005);
}

}  // namespace
}  // namespace rotrocc
