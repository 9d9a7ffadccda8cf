#include "node/trajectory_store.h"

#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

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

class TrajectoryStoreTest : public testing::Test {
 protected:
  void expectLength(const std::string& name, std::size_t poses) const {
    EXPECT_EQ(readTrajectory(directory_ / name).size(), poses) << name;
  }

  TemporaryDirectory directory_;
};

TEST_F(TrajectoryStoreTest, BothFilesAreThoseOfTheWriter) {
  for (const char* format : {"tum", "kitti"}) {
    const std::string path = directory_ / format;
    {
      TrajectoryStore store(3000, path, format);
      TrajectoryWriter writer(path + "_expected", trajectoryFormat(format), "the left camera");
      for (int i = 0; i < 3000; ++i) {
        store.add(poseAt(0.1 * i));
        writer.write(poseAt(0.1 * i));
      }
      EXPECT_EQ(store.save(path + "_saved", format),
                "wrote 3000 poses of the left camera to " + path + "_saved");
    }
    EXPECT_EQ(readFile(path), readFile(path + "_expected"));
    EXPECT_EQ(readFile(path + "_saved"), readFile(path + "_expected"));
  }
}

TEST_F(TrajectoryStoreTest, SavesTheLatestInOrder) {
  constexpr int kPoses = 2000;
  for (const auto& [max_length, length] :
       std::vector<std::pair<std::size_t, int>>{{4, 4}, {300, 300}, {5000, 1100}}) {
    TrajectoryStore store(max_length);
    for (int i = 0; i < kPoses; ++i) store.add(poseAt(i), i == 100 || i == 900);
    store.save(directory_ / "poses", "tum");
    const Trajectory saved = readTrajectory(directory_ / "poses");
    ASSERT_EQ(saved.size(), static_cast<std::size_t>(length));
    for (int i = 0; i < length; ++i) {
      ASSERT_EQ(saved[static_cast<std::size_t>(i)].stamp_ns, poseAt(kPoses - length + i).stamp_ns);
    }
  }
}

TEST_F(TrajectoryStoreTest, WhatWasThereStaysIfSavingFails) {
  const std::string path = directory_.write("poses", "an earlier drive\n");
  TrajectoryStore store(20000);
  for (int i = 0; i < 20000; ++i) store.add(poseAt(i));
  {
    const FileSizeLimit limit(100'000);
    expectError([&] { store.save(path, "tum"); }, "cannot write to");
  }
  EXPECT_EQ(readFile(path), "an earlier drive\n");
  EXPECT_EQ(directory_.files(), 1u) << "a temporary file is left";
  store.save(path, "tum");
  expectLength("poses", 20000);
}

TEST_F(TrajectoryStoreTest, RejectsWhatIsNoFile) {
  const std::string fifo = directory_ / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  TrajectoryStore store(4);
  expectError([&] { store.save(directory_ / "poses", "tum"); }, "there are no poses");
  store.add(poseAt(0));
  expectError([&] { store.save("", "tum"); }, "the path is empty");
  const std::vector<std::vector<std::string>> rows = {
      {fifo, "tum", "fifo: it is not a file"},
      {"/dev/null", "tum", "/dev/null: it is not a file"},
      {directory_ / "", "tum", "it is not a file"},
      {directory_ / "no/poses", "tum", "cannot write"},
      {directory_ / "poses", "csv", "csv"}};
  for (const auto& row : rows) {
    expectError([&] { store.save(row[0], row[1]); }, row[2]);
    expectError([&] { TrajectoryStore(4, row[0], row[1]); }, row[2]);
  }
  EXPECT_EQ(directory_.files(), 1u);
}

TEST_F(TrajectoryStoreTest, ATrajectoryHasAFileOfItsOwnAndReplacesNone) {
  directory_.write("odom.txt", "an earlier drive\n");
  directory_.write("odom_3.txt", "");
  {
    TrajectoryStore store(1, directory_ / "odom.txt");
    for (const double time_s : {1.0, 2.0}) store.add(poseAt(time_s));
    for (const double time_s : {3.0, 4.0, 5.0})
      store.add(poseAt(time_s), time_s == 3.0);                        // a reset
    for (const double time_s : {1.5, 2.5}) store.add(poseAt(time_s));  // a time jump
    store.add(poseAt(2.5));                                            // a repeated stamp
  }
  EXPECT_EQ(readFile(directory_ / "odom.txt"), "an earlier drive\n");
  EXPECT_EQ(readFile(directory_ / "odom_3.txt"), "");
  expectLength("odom_2.txt", 2);
  expectLength("odom_4.txt", 3);
  expectLength("odom_5.txt", 2);
  expectLength("odom_6.txt", 1);
  EXPECT_EQ(directory_.files(), 6u);
}

TEST_F(TrajectoryStoreTest, AFullDiskEndsTheFileOfThisTrajectoryAlone) {
  const LogRecorder log;
  TrajectoryStore store(200, directory_ / "odom.txt");
  {
    const FileSizeLimit limit(1000);
    for (int i = 0; i < 100; ++i) store.add(poseAt(0.1 * i));
    EXPECT_EQ(store.fault().find("cannot write to"), 0u) << store.fault();
  }
  EXPECT_EQ(log.with("the rest of this trajectory is not in it").size(), 1u);
  store.save(directory_ / "saved.txt", "tum");
  expectLength("saved.txt", 100);
  for (int i = 100; i < 150; ++i) store.add(poseAt(0.1 * i), i == 100);
  EXPECT_EQ(store.fault(), "");
  expectLength("odom_2.txt", 50);
}

}  // namespace
}  // namespace rotrocc
