// The files of trajectory_file and of ~save_trajectory over resets, time jumps and a respawn.

#include <sys/stat.h>

#include <std_srvs/Trigger.h>

#include "nodelet_drive.h"
#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/trajectory.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr std::size_t kPairs = 4;  // of each trajectory

class TrajectoryFilesTest : public testing::Test {
 protected:
  /// Each pair has its odometry before the next one comes.
  static void drivePairs(NodeletDrive& drive) {
    drive.setUp();
    for (std::size_t i = 0; i < kPairs; ++i) drive.odometryOf(drive.robot.drive());
  }

  std::size_t posesIn(const std::string& name) const {
    return readTrajectory(directory_ / name).size();
  }

  TemporaryDirectory directory_;
};

TEST_F(TrajectoryFilesTest, EachTrajectoryIsKept) {
  const RunningNodelet::Parameters parameters = {{"trajectory_file", directory_ / "odom.txt"}};
  {
    NodeletDrive drive(parameters);
    drivePairs(drive);
    std_srvs::Trigger reset;
    ASSERT_TRUE(drive.services.call("reset", reset));
    drivePairs(drive);
    drive.robot.turnBackTime();
    drivePairs(drive);
  }
  {
    NodeletDrive respawned(parameters);
    drivePairs(respawned);
  }
  for (const char* name : {"odom.txt", "odom_2.txt", "odom_3.txt", "odom_4.txt"}) {
    EXPECT_EQ(posesIn(name), kPairs) << name;
  }
  EXPECT_EQ(directory_.files(), 4u);
}

TEST_F(TrajectoryFilesTest, AFifoDoesNotStopTheOdometry) {
  const std::string fifo = directory_ / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  NodeletDrive drive;
  drivePairs(drive);
  SaveTrajectory save;
  save.request.path = fifo;
  save.request.format = "tum";
  ASSERT_TRUE(drive.services.call("save_trajectory", save));
  EXPECT_FALSE(save.response.success);
  EXPECT_NE(save.response.message.find("it is a FIFO"), std::string::npos) << save.response.message;
  drivePairs(drive);
  save.request.path = directory_ / "poses.txt";
  ASSERT_TRUE(drive.services.call("save_trajectory", save));
  EXPECT_EQ(save.response.message,
            "wrote 8 poses of the left camera to " + directory_ / "poses.txt");
  EXPECT_EQ(posesIn("poses.txt"), 2 * kPairs);
}

}  // namespace
}  // namespace rotrocc
