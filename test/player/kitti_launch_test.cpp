// Replays bags through kitti.launch, as users do, on the master of rostest.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "bags/kitti_bag_writer.h"
#include "support/kitti2bag_writer.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 15;

class KittiLaunchTest : public ::testing::Test {
 protected:
  KittiSequence syntheticSequence() const {
    writeSyntheticSequence(directory_ / "sequence", kPairs);
    return KittiSequence(directory_ / "sequence");
  }

  std::string bag() const { return directory_ / "test.bag"; }

  void writeOwnBag(const KittiSequence& sequence) const {
    KittiBagWriter writer(bag(), sequence, 1000);
    for (int i = 0; i < sequence.size(); ++i) writer.writePair(i);
    writer.finish();
  }

  /// Replays bag() to its end.
  static CommandResult replay(const std::string& bag, const std::string& options = "") {
    // On a busy machine a response may take long.
    std::string command =
        "roslaunch rotrocc kitti.launch rviz:=false lockstep_timeout:=600 bag:=" + bag + options;
    // Preloads a sanitizer for programs built without it: see scripts/sanitize.
    const char* preload = std::getenv("ROTROCC_PRELOAD");
    if (preload != nullptr && *preload != '\0') {
      command += std::string(" launch_prefix:='env LD_PRELOAD=") + preload + "'";
    }
    return runCommand(command);
  }

  /// Expects that the nodelet receives every pair of bag(), and ends at the pose of
  /// offline_odometry.
  void expectReplayAsOffline(int pairs) const {
    const CommandResult launch = replay(bag(),
                                        " rate:=0 trajectory_file:=" + directory_ / "live.txt" +
                                            " ground_truth_file:=" + directory_ / "truth.txt");
    EXPECT_EQ(launch.status, 0) << launch.output;
    const CommandResult offline =
        runCommand(std::string(OFFLINE_ODOMETRY) + " " + bag() + " --format tum --trajectory " +
                   directory_ / "offline.txt");
    EXPECT_EQ(offline.status, 0) << offline.output;

    const std::string live = readFile(directory_ / "live.txt");
    EXPECT_EQ(std::count(live.begin(), live.end(), '\n'), pairs) << launch.output;
    EXPECT_TRUE(live == readFile(directory_ / "offline.txt"));
    EXPECT_EQ(readTrajectory(directory_ / "truth.txt").size(), static_cast<std::size_t>(pairs));
    const std::string played = std::to_string(pairs) + " pairs played, " + std::to_string(pairs) +
                               " with odometry, 0 lost, 0 dropped";
    EXPECT_NE(launch.output.find(played), std::string::npos) << launch.output;
  }

  TemporaryDirectory directory_;
};

TEST_F(KittiLaunchTest, ReplaysOwnBags) {
  writeOwnBag(syntheticSequence());
  expectReplayAsOffline(kPairs);
}

TEST_F(KittiLaunchTest, ReplaysRawDrivesOfKitti2bag) {
  writeKitti2bagRaw(syntheticSequence(), bag());
  expectReplayAsOffline(kPairs);
}

TEST_F(KittiLaunchTest, ReplaysOdometrySequencesOfKitti2bag) {
  writeKitti2bagOdometry(syntheticSequence(), bag());
  expectReplayAsOffline(kPairs);
}

TEST_F(KittiLaunchTest, ReplaysRealImages) {
  const char* directory = std::getenv("ROTROCC_KITTI_DIR");
  if (directory == nullptr) GTEST_SKIP() << "needs KITTI sequences in $ROTROCC_KITTI_DIR";
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const KittiSequence sequence(entry.path().string());
    writeOwnBag(sequence);
    expectReplayAsOffline(sequence.size());
    return;  // one will do
  }
  FAIL() << directory << " is empty";
}

TEST_F(KittiLaunchTest, EndsWithAWordWhenThereIsNoBag) {
  const CommandResult launch = replay(directory_ / "missing.bag");
  EXPECT_NE(launch.output.find("missing.bag is not readable as a bag"), std::string::npos)
      << launch.output;
}

}  // namespace
}  // namespace rotrocc
