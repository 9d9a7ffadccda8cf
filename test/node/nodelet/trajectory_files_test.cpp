// The files of trajectory_file, ~save_trajectory and continue_from over resets, time jumps and a
// respawn.

#include <cmath>

#include <std_srvs/Trigger.h>

#include "nodelet_drive.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/trajectory.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr std::size_t kPairs = 4;  // of each trajectory

/// Each pair has its odometry before the next one comes.
void drivePairs(NodeletDrive& drive) {
  drive.setUp();
  for (std::size_t i = 0; i < kPairs; ++i) drive.odometryOf(drive.robot.drive());
}

TEST(TrajectoryFilesTest, EachTrajectoryIsKept) {
  const TemporaryDirectory directory;
  const std::string saved = directory / "saved.txt";
  const RunningNodelet::Parameters parameters = {{"trajectory_file", directory / "odom.txt"}};
  {
    NodeletDrive drive(parameters);
    drivePairs(drive);
    std_srvs::Trigger reset;
    ASSERT_TRUE(drive.services.call("reset", reset));
    drivePairs(drive);
    SaveTrajectory save;
    save.request.path = saved;
    save.request.format = "tum";
    ASSERT_TRUE(drive.services.call("save_trajectory", save));
    EXPECT_EQ(save.response.message, "wrote 4 poses of the left camera to " + saved);
    drive.robot.setTime(ros::Time(900.0));
    drivePairs(drive);
  }
  {
    NodeletDrive respawned(parameters);
    drivePairs(respawned);
  }
  for (const char* name : {"odom.txt", "odom_2.txt", "odom_3.txt", "odom_4.txt", "saved.txt"}) {
    EXPECT_EQ(readTrajectory(directory / name).size(), kPairs) << name;
  }
  EXPECT_EQ(directory.files(), 5u);
}

/// The pose of the base at the first pair.
double firstX(NodeletDrive& drive) {
  drive.setUp();
  return drive.odometryOf(drive.robot.drive()).pose.pose.position.x;
}

TEST(ContinueFromTest, ANodeletContinuesFromItsFileOrSaysWhyNot) {
  const TemporaryDirectory directory;
  const std::string file = directory / "pose";
  const RunningNodelet::Parameters parameters = {{"continue_from", file}};
  double last_m = 0.0;
  {
    NodeletDrive drive(parameters);
    EXPECT_EQ(drive.log.with("there is no " + file + " yet").size(), 1u);
    drivePairs(drive);
    last_m = drive.odometryOf(drive.robot.drive()).pose.pose.position.x;
    EXPECT_GT(last_m, 1.0);
  }
  const auto respawnAt = [&](double before_s) {
    std::string text = readFile(file);
    // Each robot drives in the same time: turn that of the file back.
    const std::size_t at = text.find("odom ") + 5;
    const std::size_t length = text.find(' ', at) - at;
    const auto stamp_ns = std::stoll(text.substr(at, length)) - std::llround(1e9 * before_s);
    directory.write("pose", text.replace(at, length, std::to_string(stamp_ns)));
  };
  respawnAt(2.0);
  {
    NodeletDrive drive(parameters);
    EXPECT_NEAR(firstX(drive), last_m, 1e-9);
    std_srvs::Trigger reset;
    ASSERT_TRUE(drive.services.call("reset", reset));
    EXPECT_NEAR(firstX(drive), 0.0, 1e-9);
    drivePairs(drive);
  }
  respawnAt(-10.0);
  {
    NodeletDrive drive(parameters);
    EXPECT_NEAR(firstX(drive), 0.0, 1e-9);
    EXPECT_EQ(drive.log.with("the pose of " + file + " is of 1010").size(), 1u);
  }
  const std::string whole = readFile(file);
  const std::pair<std::string, std::string> damages[] = {
      {"", "has no data"},
      {whole.substr(0, whole.rfind("end")), "is not a whole pose"},
      {std::string(whole.size(), '\0'), "is not a whole pose"}};
  for (const auto& [damaged, why] : damages) {
    directory.write("pose", damaged);
    NodeletDrive drive(parameters);
    EXPECT_NEAR(firstX(drive), 0.0, 1e-9);
    EXPECT_EQ(drive.log.with(why).size(), 1u) << why;
  }
  directory.write("pose", "# timestamp tx ty tz qx qy qz qw\n");
  EXPECT_THROW(RunningNodelet nodelet(parameters), std::exception) << "would lose the file";
}

}  // namespace
}  // namespace rotrocc
