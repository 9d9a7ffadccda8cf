#include "node/trajectory_history.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

StampedPose poseAt(int index) {
  StampedPose pose;
  pose.stamp_ns = 1'000'000'000 + index * 100'000'000;
  pose.T_world_body.translation().z() = index;
  return pose;
}

TEST(TrajectoryHistoryTest, WritesBothFormats) {
  const TemporaryDirectory directory;
  TrajectoryHistory history(100);
  for (int i = 0; i < 10; ++i) history.add(poseAt(i));
  for (const char* format : {"tum", "kitti"}) {
    const std::string path = directory / format;
    EXPECT_EQ(history.save(path, format), "wrote 10 poses of the left camera to " + path);
    const Trajectory written = readTrajectory(path);
    ASSERT_EQ(written.size(), 10u);
    EXPECT_EQ(written[7].T_world_body.translation().z(), 7.0);
  }
  EXPECT_EQ(readTrajectory(directory / "tum")[3].stamp_ns, poseAt(3).stamp_ns);
}

TEST(TrajectoryHistoryTest, KeepsTheLatest) {
  const TemporaryDirectory directory;
  TrajectoryHistory history(4);
  for (int i = 0; i < 10; ++i) history.add(poseAt(i));
  history.save(directory / "poses", "tum");
  const Trajectory written = readTrajectory(directory / "poses");
  ASSERT_EQ(written.size(), 4u);
  EXPECT_EQ(written[0].stamp_ns, poseAt(6).stamp_ns);
}

TEST(TrajectoryHistoryTest, SaysWhyNothingIsWritten) {
  const TemporaryDirectory directory;
  TrajectoryHistory history(4);
  expectError([&] { history.save(directory / "poses", "tum"); }, "there are no poses");
  history.add(poseAt(0));
  expectError([&] { history.save("", "tum"); }, "the path is empty");
  expectError([&] { history.save(directory / "poses", "csv"); }, "csv");
  expectError([&] { history.save(directory / "no/poses", "tum"); }, "cannot write");
  expectError([&] { history.save("/dev/full", "tum"); }, "is the disk full?");
  history.clear();
  expectError([&] { history.save(directory / "poses", "tum"); }, "there are no poses");
}

}  // namespace
}  // namespace rotrocc
