// The files of trajectory_file and of ~save_trajectory over resets, time jumps and a respawn.

#include <sys/stat.h>

#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include "rotrocc/SaveTrajectory.h"
#include "rotrocc/trajectory.h"
#include "support/run_command.h"
#include "support/service_caller.h"
#include "support/simulated_robot.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr std::size_t kPairs = 4;  // of each trajectory

/// An odometry that runs until the end of the scope.
class OdometryProcess {
 public:
  explicit OdometryProcess(const std::string& arguments)
      : thread_([=] {
          result_ = runCommand("exec " STEREO_ODOMETRY " __name:=stereo_odometry " + arguments);
        }) {}

  ~OdometryProcess() {
    runCommand("rosnode kill stereo_odometry");
    ros::param::del("stereo_odometry");
    thread_.join();
    EXPECT_EQ(result_.status, 0) << result_.output;
  }

 private:
  CommandResult result_;
  std::thread thread_;
};

class TrajectoryFilesTest : public testing::Test {
 protected:
  void SetUp() override { spinner_.start(); }

  /// Each pair has its odometry before the next one comes.
  static void drive(SimulatedRobot& robot) {
    robot.publishInfos();
    robot.publishMount();
    for (std::size_t i = 0; i < kPairs; ++i) ASSERT_TRUE(robot.odometryOf(robot.drive()));
  }

  std::size_t posesIn(const std::string& name) const {
    return readTrajectory(directory_ / name).size();
  }

  std::size_t files() const {
    const std::filesystem::directory_iterator files(directory_ / "");
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
  }

  ros::AsyncSpinner spinner_{2};
  TemporaryDirectory directory_;
};

TEST_F(TrajectoryFilesTest, EachTrajectoryIsKept) {
  const std::string option = "_trajectory_file:=" + directory_ / "odom.txt";
  {
    const OdometryProcess odometry(option);
    SimulatedRobot robot;
    ServiceCaller services("stereo_odometry");
    drive(robot);
    std_srvs::Trigger reset;
    ASSERT_TRUE(services.call("reset", reset));
    drive(robot);
    robot.turnBackTime();
    drive(robot);
  }
  {
    const OdometryProcess respawned(option);
    SimulatedRobot robot;
    drive(robot);
  }
  for (const char* name : {"odom.txt", "odom_2.txt", "odom_3.txt", "odom_4.txt"}) {
    EXPECT_EQ(posesIn(name), kPairs) << name;
  }
  EXPECT_EQ(files(), 4u);
}

TEST_F(TrajectoryFilesTest, AFifoDoesNotStopTheOdometry) {
  const std::string fifo = directory_ / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  const OdometryProcess odometry("");
  SimulatedRobot robot;
  ServiceCaller services("stereo_odometry");
  drive(robot);
  SaveTrajectory save;
  save.request.path = fifo;
  save.request.format = "tum";
  ASSERT_TRUE(services.call("save_trajectory", save));
  EXPECT_FALSE(save.response.success);
  EXPECT_NE(save.response.message.find("it is a FIFO"), std::string::npos) << save.response.message;
  drive(robot);
  save.request.path = directory_ / "poses.txt";
  ASSERT_TRUE(services.call("save_trajectory", save));
  EXPECT_EQ(save.response.message,
            "wrote 8 poses of the left camera to " + directory_ / "poses.txt");
  EXPECT_EQ(posesIn("poses.txt"), 2 * kPairs);
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "trajectory_files_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
