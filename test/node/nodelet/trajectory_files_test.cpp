// The files of trajectory_file and ~save_trajectory over resets, time jumps and a respawn.

#include <std_srvs/Trigger.h>

#include "nodelet_drive.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/trajectory.h"
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

}  // namespace
}  // namespace rotrocc
