// A robot whose camera_info arrives late, and its tf later than the buffer length of tf2.

#include <chrono>
#include <cmath>
#include <utility>

#include "nodelet_drive.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;

constexpr double kTfMemory_s = 10.0;

TEST(LateTfTest, OdometryWaitsAndStartsByItself) {
  NodeletDrive drive({{"no_input_warning_s", 0.5}});
  SimulatedRobot& robot = drive.robot;
  EXPECT_TRUE(robot.statusWith(OdometryStatus::NO_INPUT));
  const ros::Time first = robot.drive();
  const std::string no_info = "/left/camera_info has a publisher, but no messages arrive";
  EXPECT_TRUE(waitUntil([&] {
    robot.drive();
    return robot.statusWith(OdometryStatus::NO_CALIBRATION, no_info, milliseconds(50)) &&
           !drive.log.with("Likely: " + no_info).empty();
  }));

  robot.publishInfos();
  const std::string no_tf = "no tf from base_link to camera_left";
  EXPECT_TRUE(waitUntil([&] {
    const ros::Duration length = robot.drive() - first;
    return robot.statusWith(OdometryStatus::NO_TF, no_tf, milliseconds(20)) &&
           length.toSec() > 2.0 * kTfMemory_s && !drive.log.with(no_tf).empty();
  }));
  EXPECT_FALSE(robot.odometryOf(first, milliseconds(0)));

  // Only the newest pair was kept for tf.
  robot.publishMount();
  const auto odometry = robot.odometryFrom(first);
  ASSERT_TRUE(odometry);
  EXPECT_GT((odometry->header.stamp - first).toSec(), kTfMemory_s);
  EXPECT_EQ(odometry->header.frame_id, "odom");
  EXPECT_EQ(odometry->child_frame_id, "base_link");
  EXPECT_EQ(odometry->pose.pose.position.x, 0.0);
  EXPECT_EQ(odometry->pose.pose.orientation.w, 1.0);
  EXPECT_EQ(odometry->twist.covariance[0], 9999.0);
  EXPECT_EQ(drive.statusOf(odometry->header.stamp).state, OdometryStatus::INITIALIZING);

  // Other pairs may be pending, and be left out: then the next one is too far away.
  double before_m = 0.0;
  EXPECT_TRUE(waitUntil([&] {
    const double after_m = drive.odometryOf(robot.drive()).pose.pose.position.x;
    const double step_m = after_m - std::exchange(before_m, after_m);
    return std::abs(step_m - SimulatedRobot::kStep_m) < 0.02;
  }));
}

TEST(LateTfTest, TheStateIsNotOfTfOnceItIsThere) {
  NodeletDrive drive;
  drive.robot.publishInfos();
  EXPECT_TRUE(waitUntil([&] {
    drive.robot.drive();
    return drive.robot.statusWith(OdometryStatus::NO_TF, "", milliseconds(50)).has_value();
  }));
  drive.robot.publishMount();
  EXPECT_TRUE(waitUntil([&] {
    drive.robot.drive([](sensor_msgs::Image& image) { image.data.pop_back(); });
    return drive.robot.statusWith(OdometryStatus::NO_INPUT, "bytes of data", milliseconds(50))
        .has_value();
  }));
}

}  // namespace
}  // namespace rotrocc
