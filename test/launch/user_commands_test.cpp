// What the documentation tells users to type, with the packages of scripts/setup and beside a robot
// that drives.

#include <atomic>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include "support/background_command.h"
#include "support/read_file.h"
#include "support/run_command.h"
#include "support/simulated_robot.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(100);

class UserCommandsTest : public ::testing::Test {
 protected:
  UserCommandsTest()
      : mount_(
            "rosrun tf2_ros static_transform_publisher 1 0 1.5 -1.5708 0 -1.5708 base_link "
            "camera_left",
            directory_ / "mount") {
    robot_.publishInfos();
    driver_ = std::thread([this] {
      while (!arrived_) {
        robot_.drive();
        std::this_thread::sleep_for(kPeriod);
      }
    });
  }
  ~UserCommandsTest() override {
    arrived_ = true;
    driver_.join();
  }

  /// Expects that the command ends well and prints `part`.
  static void expectPrints(const std::string& command, const std::string& part) {
    // Only against hanging.
    const CommandResult result = runCommand("timeout 120 " + command);
    EXPECT_EQ(result.status, 0) << command << "\n" << result.output;
    EXPECT_NE(result.output.find(part), std::string::npos) << command << "\n" << result.output;
  }

  TemporaryDirectory directory_;
  SimulatedRobot robot_;
  BackgroundCommand mount_;
  std::atomic<bool> arrived_{false};
  std::thread driver_;
};

TEST_F(UserCommandsTest, TopicsCanBeShown) {
  expectPrints("rostopic echo -n 1 odom", "child_frame_id: \"base_link\"");
  expectPrints("rostopic echo -n 1 status", "rotation_inliers:");
  expectPrints("rostopic echo -n 1 --noarr inliers", "height: 1");
  expectPrints("rostopic echo -n 1 /tf", "child_frame_id: \"base_link\"");
}

TEST_F(UserCommandsTest, ServicesCanBeCalled) {
  expectPrints("rosservice call stereo_odometry/reset", "success: True");
  expectPrints("rosservice call stereo_odometry/pause false", "success: True");
  expectPrints("rosservice type stereo_odometry/set_pose", "rotrocc/SetPose");
  expectPrints("rossrv show rotrocc/SetPose", "geometry_msgs/");
  expectPrints("rostopic echo -n 1 odom/header/frame_id", "odom");  // there is a pose to save
  expectPrints(
      "rosservice call stereo_odometry/save_trajectory " + directory_ / "poses.txt" + " tum",
      "success: True");
}

TEST_F(UserCommandsTest, TransformsAndParametersCanBeShown) {
  expectPrints(
      "rosrun dynamic_reconfigure dynparam set stereo_odometry motion_check/min_inliers 30", "");
  expectPrints("rosrun dynamic_reconfigure dynparam get stereo_odometry",
               "'motion_check/min_inliers': 30");
  const std::string log = directory_ / "echo";
  BackgroundCommand echo("rosrun tf2_tools echo.py odom base_link", log);
  EXPECT_TRUE(waitUntil([&] { return readFile(log).find("Translation") != std::string::npos; }))
      << readFile(log);
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  ros::init(argc, argv, "user_commands_test");
  const ros::NodeHandle nh;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
