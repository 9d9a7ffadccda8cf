// A camera that moves on a robot at rest, and another camera in its place.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

/// Along the base's x axis, and looking along it.
geometry_msgs::TransformStamped mountAt(double x_m, const std::string& frame) {
  geometry_msgs::TransformStamped mount;
  mount.header.frame_id = "base_link";
  mount.child_frame_id = frame;
  mount.transform.translation.x = x_m;
  mount.transform.rotation.x = -0.5;
  mount.transform.rotation.y = 0.5;
  mount.transform.rotation.z = -0.5;
  mount.transform.rotation.w = 0.5;
  return mount;
}

TEST(MovingMountTest, TheBaseRestsWhileItsCameraMoves) {
  ros::AsyncSpinner spinner(2);
  spinner.start();
  SimulatedRobot robot;
  robot.publishInfos();
  tf2_ros::TransformBroadcaster joints;
  tf2_ros::StaticTransformBroadcaster fixed;
  double x_m = 1.0;
  std::optional<nav_msgs::Odometry> odometry;
  // The tf of a joint comes after the images, and its first messages may be lost.
  const auto drive = [&] {
    auto [left, right] = robot.see();
    robot.publish(left, right);
    geometry_msgs::TransformStamped mount = mountAt(x_m, "camera_left");
    mount.header.stamp = left.header.stamp;
    x_m += SimulatedRobot::kStep_m;
    EXPECT_TRUE(waitUntil([&] {
      joints.sendTransform(mount);
      odometry = robot.odometryOf(left.header.stamp, std::chrono::milliseconds(100));
      return odometry.has_value();
    }));
    return odometry.value_or(nav_msgs::Odometry());
  };
  for (int pair = 0; pair < 8; ++pair) {
    const nav_msgs::Odometry at_rest = drive();
    EXPECT_NEAR(at_rest.pose.pose.position.x, 0.0, 0.05) << pair;
    EXPECT_NEAR(at_rest.twist.twist.linear.x, 0.0, 0.2) << pair;
  }

  // Now the base drives: its new camera is fixed, and where the other one was.
  fixed.sendTransform(mountAt(x_m, "other_camera"));
  const auto driveWithOther = [&] {
    const ros::Time stamp =
        robot.drive([](sensor_msgs::Image& image) { image.header.frame_id = "other_camera"; });
    odometry = robot.odometryOf(stamp);
    EXPECT_TRUE(odometry);
    return odometry.value_or(nav_msgs::Odometry());
  };
  const double before_m = driveWithOther().pose.pose.position.x;
  for (int pair = 0; pair < 3; ++pair) odometry = driveWithOther();
  EXPECT_NEAR(odometry->pose.pose.position.x - before_m, 3 * SimulatedRobot::kStep_m, 0.05);
  const auto status = robot.statusOf(odometry->header.stamp);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->header.frame_id, "other_camera");
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "moving_mount_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
