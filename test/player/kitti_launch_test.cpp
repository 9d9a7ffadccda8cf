// Replays bags through kitti.launch, as users do, on the master of rostest.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "bags/sequence_bag_writer.h"
#include "sequences/stereo_sequence.h"
#include "support/background_command.h"
#include "support/kitti2bag_writer.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/synthetic_scene.h"
#include "support/temporary_directory.h"
#include "support/wait_until.h"

namespace rotrocc {
namespace {

constexpr int kPairs = 15;

class KittiLaunchTest : public ::testing::Test {
 protected:
  StereoSequence syntheticSequence() const {
    writeSyntheticSequence(directory_ / "sequence", kPairs);
    return openStereoSequence(directory_ / "sequence", {});
  }

  std::string bag() const { return directory_ / "test.bag"; }

  void writeOwnBag(const StereoSequence& sequence) const { writeSequenceBag(bag(), sequence.root); }

  /// Replays bag() to its end.
  static CommandResult replay(const std::string& bag,
                              const std::string& options = "",
                              const std::string& environment = "") {
    // On a busy machine a response may take long.
    std::string command =
        environment +
        " roslaunch rotrocc kitti.launch rviz:=false lockstep_timeout:=600 bag:=" + bag + options;
    // Preloads a sanitizer for programs built without it: see scripts/sanitize.
    const char* preload = std::getenv("ROTROCC_PRELOAD");
    if (preload != nullptr && *preload != '\0') {
      command += std::string(" launch_prefix:='env LD_PRELOAD=") + preload + "'";
    }
    return runCommand(command);
  }

  /// A trajectory without its stamps: those of a sequence begin at 0, but not in ROS.
  static std::string poses(const std::string& trajectory) {
    return std::regex_replace(trajectory, std::regex("(^|\\n)[^ ]*"), "\n");
  }

  /// The start of a drive with wide lenses, rendered.
  void writeRawBag(int pairs) const {
    const std::string drive = directory_ / "drive";
    const CommandResult rendered = runCommand(
        std::string(SIMULATE_DRIVE) + " slip_road " + drive +
        " --layout asl --lens radtan --size 480x240 --focal 300 --frames " + std::to_string(pairs));
    ASSERT_EQ(rendered.status, 0) << rendered.output;
    const CommandResult written =
        runCommand(std::string(SEQUENCE_TO_BAG) + " " + drive + " " + bag());
    ASSERT_EQ(written.status, 0) << written.output;
  }

  /// Expects that the nodelet receives every pair of a recording, and has the poses of
  /// offline_odometry.
  void expectReplayAsOffline(int pairs,
                             const std::string& recording,
                             const std::string& launch_options = "",
                             const std::string& offline_options = "") const {
    std::filesystem::remove(directory_ / "live.txt");  // the node replaces no file
    const CommandResult launch =
        replay(recording,
               launch_options + " rate:=0 trajectory_file:=" + directory_ / "live.txt" +
                   " ground_truth_file:=" + directory_ / "truth.txt");
    EXPECT_EQ(launch.status, 0) << launch.output;
    const CommandResult offline =
        runCommand(std::string(OFFLINE_ODOMETRY) + " " + recording + " --format tum --trajectory " +
                   directory_ / "offline.txt" + offline_options);
    EXPECT_EQ(offline.status, 0) << offline.output;

    const std::string live = readFile(directory_ / "live.txt");
    EXPECT_EQ(std::count(live.begin(), live.end(), '\n'), pairs + 1) << launch.output;
    EXPECT_TRUE(poses(live) == poses(readFile(directory_ / "offline.txt")));
    EXPECT_EQ(readTrajectory(directory_ / "truth.txt").size(), static_cast<std::size_t>(pairs));
    const std::string played = std::to_string(pairs) + " pairs played, " + std::to_string(pairs) +
                               " answered, 0 lost, 0 dropped";
    EXPECT_NE(launch.output.find(played), std::string::npos) << launch.output;
    EXPECT_EQ(launch.output.find("unload_nodelet"), std::string::npos)
        << "a clean end warns of nothing: " << launch.output;
  }

  TemporaryDirectory directory_;
};

TEST_F(KittiLaunchTest, ReplaysSequences) {
  expectReplayAsOffline(kPairs, syntheticSequence().root);
}

TEST_F(KittiLaunchTest, ReplaysBagsOfKitti2bag) {
  for (const auto write : {writeKitti2bagRaw, writeKitti2bagOdometry}) {
    write(syntheticSequence(), bag());
    expectReplayAsOffline(kPairs, bag());
  }
}

TEST_F(KittiLaunchTest, ReplaysRawImages) {
  writeRawBag(8);
  expectReplayAsOffline(8, bag(), " rectify:=true", " --rectify yes");
}

/// With a program in the place of rviz that does nothing.
TEST_F(KittiLaunchTest, EndsByItselfIfTheBagCannotBePlayed) {
  const std::string program = directory_.write("rviz", "#!/bin/sh\nexec sleep infinity\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const CommandResult launch =
      replay(directory_ / "missing.bag",
             " rviz:=true",
             "PATH=" + directory_ / "" + ":$PATH ROS_HOME=" + directory_ / "" +
                 " timeout --signal INT 120");
  EXPECT_NE(launch.status, 124) << "still open: " << launch.output;
  EXPECT_NE(launch.output.find("missing.bag does not exist"), std::string::npos) << launch.output;
}

/// What /use_sim_time was before.
TEST_F(KittiLaunchTest, TheClockIsThatOfBefore) {
  for (const std::string value : {"true", "false"}) {
    ASSERT_EQ(runCommand("rosparam set /use_sim_time " + value).status, 0);
    replay(directory_ / "missing.bag");
    EXPECT_EQ(runCommand("rosparam get /use_sim_time").output, value + "\n");
  }
  const BackgroundCommand clock("rostopic pub --latch /clock rosgraph_msgs/Clock 'clock: 1'",
                                directory_ / "clock.txt");
  ASSERT_TRUE(waitUntil([] { return runCommand("rostopic info /clock").status == 0; }));
  replay(directory_ / "missing.bag");
  EXPECT_EQ(runCommand("rosparam get /use_sim_time").output, "true\n") << "another simulation";
  runCommand("rosparam delete /use_sim_time");
}

}  // namespace
}  // namespace rotrocc
