#include "node/trajectory/trajectory_recorder.h"

#include <sys/stat.h>

#include <cmath>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/log_recorder.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

StampedPose poseAt(double time_s) {
  StampedPose pose;
  pose.stamp_ns = std::llround(1e9 * time_s);
  pose.T_world_body.translation().z() = time_s;
  return pose;
}

TEST(TrajectoryRecorderTest, NamesAreNumbered) {
  EXPECT_EQ(numberedPath("/a/odom.txt", 1), "/a/odom.txt");
  EXPECT_EQ(numberedPath("/a/odom.txt", 2), "/a/odom_2.txt");
  EXPECT_EQ(numberedPath("/a.b/odom", 12), "/a.b/odom_12");
}

TEST(TrajectoryRecorderTest, WritesTheSameAsTheWriter) {
  const TemporaryDirectory directory;
  for (const char* format : {"tum", "kitti"}) {
    const std::string path = directory / format;
    {
      TrajectoryRecorder recorder(path, format);
      TrajectoryWriter writer(path + "_expected", trajectoryFormat(format));
      for (int i = 0; i < 3000; ++i) {
        recorder.add(poseAt(0.1 * i));
        writer.write(poseAt(0.1 * i));
      }
    }
    EXPECT_EQ(readFile(path), readFile(path + "_expected"));
  }
}

TEST(TrajectoryRecorderTest, ATrajectoryHasAFileOfItsOwn) {
  const TemporaryDirectory directory;
  {
    TrajectoryRecorder recorder(directory / "odom.txt", "tum");
    recorder.beginNew();
    for (const double time_s : {1.0, 2.0}) recorder.add(poseAt(time_s));
    recorder.beginNew();  // a reset
    recorder.beginNew();  // without a pose: no file
    for (const double time_s : {3.0, 4.0, 5.0}) recorder.add(poseAt(time_s));
    for (const double time_s : {1.5, 2.5}) recorder.add(poseAt(time_s));  // a time jump
    recorder.add(poseAt(2.5));                                            // a repeated stamp
  }
  EXPECT_EQ(readTrajectory(directory / "odom.txt").size(), 2u);
  EXPECT_EQ(readTrajectory(directory / "odom_2.txt").size(), 3u);
  EXPECT_EQ(readTrajectory(directory / "odom_3.txt").size(), 2u);
  EXPECT_EQ(readTrajectory(directory / "odom_4.txt").size(), 1u);
  EXPECT_EQ(directory.files(), 4u);
}

TEST(TrajectoryRecorderTest, NothingIsReplaced) {
  const TemporaryDirectory directory;
  directory.write("odom.txt", "an earlier drive\n");
  directory.write("odom_3.txt", "");
  {
    TrajectoryRecorder recorder(directory / "odom.txt", "tum");
    recorder.add(poseAt(1.0));
    recorder.beginNew();
    recorder.add(poseAt(2.0));
  }
  EXPECT_EQ(readFile(directory / "odom.txt"), "an earlier drive\n");
  EXPECT_EQ(readTrajectory(directory / "odom_2.txt").front().stamp_ns, poseAt(1.0).stamp_ns);
  EXPECT_EQ(readFile(directory / "odom_3.txt"), "");
  EXPECT_EQ(readTrajectory(directory / "odom_4.txt").front().stamp_ns, poseAt(2.0).stamp_ns);
}

TEST(TrajectoryRecorderTest, AFullDiskLeavesWholeLines) {
  const TemporaryDirectory directory;
  const LogRecorder log;
  {
    const FileSizeLimit limit(1000);
    TrajectoryRecorder recorder(directory / "odom.txt", "tum");
    for (int i = 0; i < 100; ++i) recorder.add(poseAt(0.1 * i));
  }
  const Trajectory written = readTrajectory(directory / "odom.txt");
  EXPECT_GT(written.size(), 5u);
  EXPECT_LT(written.size(), 20u);
  EXPECT_EQ(log.with("trajectory file closed: cannot write to").size(), 1u);
}

TEST(TrajectoryRecorderTest, WrongPathsAreRefusedAtTheStart) {
  const TemporaryDirectory directory;
  const std::string fifo = directory / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  expectError([&] { TrajectoryRecorder(fifo, "tum"); }, "fifo: it is a FIFO");
  expectError([&] { TrajectoryRecorder("/dev/null", "tum"); }, "it is a device");
  expectError([&] { TrajectoryRecorder(directory / "no/odom.txt", "tum"); }, "cannot write");
  expectError([&] { TrajectoryRecorder(directory / "odom.txt", "csv"); }, "csv");
  EXPECT_EQ(directory.files(), 1u);
}

}  // namespace
}  // namespace rotrocc
