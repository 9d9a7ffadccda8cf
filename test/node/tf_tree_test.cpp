// The place of the odometry in tf beside another odometry, which owns the base.

#include <map>
#include <mutex>
#include <optional>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

/// The pose by wheel odometry, with a slip of 5 %.
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
  SimulatedRobot robot(2);
  std::mutex mutex;
  std::map<ros::Time, double> inverted_x_m;
  const boost::function<void(const nav_msgs::Odometry&)> on_inverted = [&](const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex);
    inverted_x_m[message.header.stamp] = message.pose.pose.position.x;
  };
  const ros::Subscriber inverted =
      ros::NodeHandle().subscribe<nav_msgs::Odometry>("inverted_odom", 100, on_inverted);
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  tf2_ros::TransformBroadcaster wheels;
  robot.publishMount();
  robot.publishInfos();

  // If the tf of the wheels is late, the pair has no tf either.
  ros::Time first;
  double way_m = 0.0;
  std::optional<nav_msgs::Odometry> odometry;
  ASSERT_TRUE(waitUntil([&] {
    const ros::Time stamp = robot.drive();
    if (first.isZero()) first = stamp;
    way_m = (stamp - first).toSec() / SimulatedRobot::kPeriod_s * SimulatedRobot::kStep_m;
    wheels.sendTransform(wheelOdometry(stamp, way_m));
    odometry = robot.odometryOf(stamp);
    const auto has_tf = [&](const char* target, const char* source) {
      return buffer.canTransform(target, source, stamp, ros::Duration(0.2));
    };
    const bool complete = has_tf("visual_odom", "base_link") && has_tf("base_link", "odom");
    const std::lock_guard<std::mutex> lock(mutex);
    return odometry && complete && inverted_x_m.count(stamp) > 0 && way_m > 1.9;
  }));
  EXPECT_NEAR(odometry->pose.pose.position.x, way_m, 0.02 + 0.02 * way_m);
  EXPECT_EQ(odometry->header.frame_id, "visual_odom");

  // The pose of the base in the visual frame is composed with that of the wheels.
  const auto pose = buffer.lookupTransform("visual_odom", "base_link", odometry->header.stamp);
  EXPECT_NEAR(pose.transform.translation.x, odometry->pose.pose.position.x, 1e-9);
  EXPECT_NEAR(pose.transform.translation.y, odometry->pose.pose.position.y, 1e-9);
  std::string parent;
  ASSERT_TRUE(buffer._getParent("base_link", odometry->header.stamp, parent));
  EXPECT_EQ(parent, "wheel_odom");
  ASSERT_TRUE(buffer._getParent("wheel_odom", odometry->header.stamp, parent));
  EXPECT_EQ(parent, "visual_odom");

  // The other odometry publishes its own frame below the base.
  const auto inverse = buffer.lookupTransform("base_link", "odom", odometry->header.stamp);
  ASSERT_TRUE(buffer._getParent("odom", odometry->header.stamp, parent));
  EXPECT_EQ(parent, "base_link");
  const std::lock_guard<std::mutex> lock(mutex);
  const double inverted_way_m = inverted_x_m.at(odometry->header.stamp);
  EXPECT_GT(inverted_way_m, SimulatedRobot::kStep_m);
  EXPECT_NEAR(inverse.transform.translation.x, -inverted_way_m, 0.01 * inverted_way_m);
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "tf_tree_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
