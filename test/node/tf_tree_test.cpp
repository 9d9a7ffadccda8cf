// Where the odometry stands in tf beside another odometry, which owns the base.

#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

/// The wheels think that the robot is here, and it drives with a slip of 5 %.
geometry_msgs::TransformStamped wheelOdometry(const ros::Time& stamp, double way_m) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = "wheel_odom";
  transform.child_frame_id = "base_link";
  transform.transform.translation.x = 1.05 * way_m;
  transform.transform.translation.y = 7.0;
  transform.transform.rotation.w = 1.0;
  return transform;
}

TEST(TfTreeTest, BaseHasOneParentOnly) {
  ros::AsyncSpinner spinner(2);
  spinner.start();
  SimulatedRobot robot;
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  tf2_ros::TransformBroadcaster wheels;
  robot.publishMount();
  std::this_thread::sleep_for(std::chrono::seconds(3));  // until both nodes have subscribed

  ros::Time stamp(1000.0);
  std::optional<nav_msgs::Odometry> odometry;
  for (int i = 0; i < 6; ++i) {
    robot.publishInfos();
    wheels.sendTransform(wheelOdometry(stamp, i * SimulatedRobot::kStep_m));
    ASSERT_EQ(robot.drive(), stamp);
    odometry = robot.odometryOf(stamp);
    ASSERT_TRUE(odometry);
    stamp += ros::Duration(SimulatedRobot::kPeriod_s);
  }
  EXPECT_NEAR(odometry->pose.pose.position.x, 5 * SimulatedRobot::kStep_m, 0.05);
  EXPECT_EQ(odometry->header.frame_id, "visual_odom");

  // The pose of the base in our frame leads through that of the wheels.
  const auto pose = buffer.lookupTransform(
      "visual_odom", "base_link", odometry->header.stamp, ros::Duration(5.0));
  EXPECT_NEAR(pose.transform.translation.x, odometry->pose.pose.position.x, 1e-9);
  EXPECT_NEAR(pose.transform.translation.y, odometry->pose.pose.position.y, 1e-9);
  std::string parent;
  ASSERT_TRUE(buffer._getParent("base_link", odometry->header.stamp, parent));
  EXPECT_EQ(parent, "wheel_odom");
  ASSERT_TRUE(buffer._getParent("wheel_odom", odometry->header.stamp, parent));
  EXPECT_EQ(parent, "visual_odom");

  // The other odometry publishes its own frame below the base.
  const auto inverse =
      buffer.lookupTransform("base_link", "odom", odometry->header.stamp, ros::Duration(5.0));
  ASSERT_TRUE(buffer._getParent("odom", odometry->header.stamp, parent));
  EXPECT_EQ(parent, "base_link");
  EXPECT_NEAR(inverse.transform.translation.x, -5 * SimulatedRobot::kStep_m, 0.05);
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "tf_tree_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
