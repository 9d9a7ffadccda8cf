#include "node/trajectory/trajectory_history.h"

#include <sys/stat.h>

#include <filesystem>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

StampedPose poseAt(int index) {
  StampedPose pose;
  pose.stamp_ns = 1'000'000'000 + std::int64_t{index} * 100'000'000;
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

TEST(TrajectoryHistoryTest, KeepsTheLatestInOrder) {
  constexpr int kPoses = 2000;
  const TemporaryDirectory directory;
  for (const int length : {4, 300}) {
    TrajectoryHistory history(static_cast<std::size_t>(length));
    for (int i = 0; i < kPoses; ++i) {
      if (i == 100 || i == 900) history.clear();
      history.add(poseAt(i));
    }
    history.save(directory / "poses", "tum");
    const Trajectory written = readTrajectory(directory / "poses");
    ASSERT_EQ(written.size(), static_cast<std::size_t>(length));
    for (int i = 0; i < length; ++i) {
      ASSERT_EQ(written[static_cast<std::size_t>(i)].stamp_ns,
                poseAt(kPoses - length + i).stamp_ns);
    }
  }
}

TEST(TrajectoryHistoryTest, WhatWasThereStaysIfWritingFails) {
  const TemporaryDirectory directory;
  const std::string path = directory.write("poses", "an earlier drive\n");
  TrajectoryHistory history(20000);
  for (int i = 0; i < 20000; ++i) history.add(poseAt(i));
  {
    const FileSizeLimit limit(100'000);
    expectError([&] { history.save(path, "tum"); }, "cannot write to");
  }
  EXPECT_EQ(readFile(path), "an earlier drive\n");
  EXPECT_EQ(directory.files(), 1u) << "a temporary file is left";
  history.save(path, "tum");
  EXPECT_EQ(readTrajectory(path).size(), 20000u);
}

TEST(TrajectoryHistoryTest, ReplacesWhereALinkPointsAndKeepsPermissions) {
  const TemporaryDirectory directory;
  const std::string path = directory.write("poses", "an earlier drive\n");
  std::filesystem::permissions(path, std::filesystem::perms(0640));
  const std::string link = directory / "link";
  std::filesystem::create_symlink(path, link);
  TrajectoryHistory history(10);
  history.add(poseAt(0));
  history.save(link, "tum");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(readTrajectory(path).size(), 1u);
  EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms(0640));
}

TEST(TrajectoryHistoryTest, RefusesWhatIsNoFile) {
  const TemporaryDirectory directory;
  const std::string fifo = directory / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  TrajectoryHistory history(10);
  history.add(poseAt(0));
  expectError([&] { history.save(fifo, "tum"); }, "fifo: it is a FIFO");
  expectError([&] { history.save("/dev/null", "tum"); }, "/dev/null: it is a device");
  expectError([&] { history.save(directory / "", "tum"); }, "it is a directory");
}

TEST(TrajectoryHistoryTest, IsSavedWhileItGrows) {
  constexpr int kPoses = 20000;
  const TemporaryDirectory directory;
  TrajectoryHistory history(1000);
  history.add(poseAt(0));
  std::thread worker([&] {
    for (int i = 1; i < kPoses; ++i) {
      history.add(poseAt(i));
      if (i % 1000 == 0) std::this_thread::yield();
    }
  });
  for (int round = 0; round < 10; ++round) {
    history.save(directory / "poses", "tum");
    const Trajectory written = readTrajectory(directory / "poses");
    EXPECT_LE(written.size(), 1000u);
    for (std::size_t i = 1; i < written.size(); ++i) {
      ASSERT_EQ(written[i].stamp_ns - written[i - 1].stamp_ns, 100'000'000) << "a pose is missing";
    }
  }
  worker.join();
}

TEST(TrajectoryHistoryTest, SaysWhyNothingIsWritten) {
  const TemporaryDirectory directory;
  TrajectoryHistory history(4);
  expectError([&] { history.save(directory / "poses", "tum"); }, "there are no poses");
  history.add(poseAt(0));
  expectError([&] { history.save("", "tum"); }, "the path is empty");
  expectError([&] { history.save(directory / "poses", "csv"); }, "csv");
  expectError([&] { history.save(directory / "no/poses", "tum"); }, "cannot write");
  history.clear();
  expectError([&] { history.save(directory / "poses", "tum"); }, "there are no poses");
}

}  // namespace
}  // namespace rotrocc
