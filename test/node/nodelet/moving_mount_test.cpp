// The mount and the frame of the camera: one that moves on a robot at rest, and another one in its
// place.

#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "input/message_conversion.h"
#include "node/odometry_messages.h"
#include "nodelet_drive.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {
namespace {

/// Along the base's x axis, and looking along it.
geometry_msgs::TransformStamped mountAt(double x_m,
                                        const ros::Time& stamp,
                                        const std::string& frame) {
  Eigen::Isometry3d T_base_camera = kittiMount();
  T_base_camera.translation() << x_m, 0.0, 0.0;
  return toTransform(T_base_camera, toNanoseconds(stamp), "base_link", frame);
}

TEST(MovingMountTest, TheBaseRestsWhileItsCameraMoves) {
  NodeletDrive drive({{"mount_timeout_s", 5.0}});
  SimulatedRobot& robot = drive.robot;
  robot.publishInfos();
  tf2_ros::TransformBroadcaster joints;
  double x_m = 1.0;
  for (int pair = 0; pair < 8; ++pair) {
    const auto [left, right] = robot.see();
    robot.publish(left, right);
    // The tf of a joint comes after the images, and its first messages may be lost.
    const geometry_msgs::TransformStamped mount = mountAt(x_m, left.header.stamp, "camera_left");
    x_m += SimulatedRobot::kStep_m;
    std::optional<nav_msgs::Odometry> at_rest;
    ASSERT_TRUE(waitUntil([&] {
      joints.sendTransform(mount);
      at_rest = robot.odometryOf(mount.header.stamp, std::chrono::milliseconds(100));
      return at_rest.has_value();
    }));
    EXPECT_NEAR(at_rest->pose.pose.position.x, 0.0, 0.05) << pair;
    EXPECT_NEAR(at_rest->twist.twist.linear.x, 0.0, 0.2) << pair;
  }

  // Now the base drives: its new camera is fixed, and where the other one was.
  tf2_ros::StaticTransformBroadcaster fixed;
  fixed.sendTransform(mountAt(x_m, ros::Time(), "other_camera"));
  const auto driveWithOther = [&] {
    return drive.odometryOf(
        robot.drive([](sensor_msgs::Image& image) { image.header.frame_id = "other_camera"; }));
  };
  const double before_m = driveWithOther().pose.pose.position.x;
  nav_msgs::Odometry odometry;
  for (int pair = 0; pair < 3; ++pair) odometry = driveWithOther();
  EXPECT_NEAR(odometry.pose.pose.position.x - before_m, 3 * SimulatedRobot::kStep_m, 0.05);
  EXPECT_EQ(drive.statusOf(odometry.header.stamp).header.frame_id, "other_camera");
}

/// tf of each third pair only: one is extrapolated, the next one waits.
TEST(MovingMountTest, SlowTfOfAMovingMountCostsNoPairAndIsTold) {
  NodeletDrive drive({{"mount_timeout_s", 0.19}});
  DiagnosticsListener diagnostics;
  SimulatedRobot& robot = drive.robot;
  robot.publishInfos();
  tf2_ros::TransformBroadcaster joints;
  double x_m = 1.0;
  for (int pair = 0; pair < 28; ++pair, x_m += SimulatedRobot::kStep_m) {
    const auto [left, right] = robot.see();
    robot.publish(left, right);
    std::vector<geometry_msgs::TransformStamped> mounts;
    if (pair < 4) mounts = {mountAt(x_m, left.header.stamp, "camera_left")};
    if (pair >= 4 && pair % 3 == 2) {
      mounts = {mountAt(x_m + SimulatedRobot::kStep_m,
                        left.header.stamp + ros::Duration(SimulatedRobot::kPeriod_s),
                        "camera_left")};
    }
    std::optional<nav_msgs::Odometry> at_rest;
    EXPECT_TRUE(waitUntil([&] {
      joints.sendTransform(mounts);
      at_rest = robot.odometryOf(left.header.stamp, std::chrono::milliseconds(100));
      return at_rest.has_value();
    })) << pair;
    ASSERT_TRUE(at_rest);
    EXPECT_NEAR(at_rest->pose.pose.position.x, 0.0, 0.05) << pair;
  }
  const std::string said =
      "tf from base_link to camera_left, which moves, comes at 3.3 Hz, too seldom";
  EXPECT_TRUE(robot.statusThat([&](const OdometryStatus& status) {
    return status.hint.find(said) == 0 && status.state == OdometryStatus::OK;
  }));
  EXPECT_EQ(drive.log.with(said).size(), 1u);
  EXPECT_TRUE(diagnostics.says("stereo_odometry: tf", said));
}

TEST(CameraFrameTest, IsThatOfTheLeftImageUnlessAParameterNamesIt) {
  const auto leaveOut = [](sensor_msgs::Image& image) { image.header.frame_id.clear(); };
  {
    NodeletDrive drive;
    drive.setUp();
    for (int i = 0; i < 3; ++i) {  // tf knows the frame of the left images only
      auto [left, right] = drive.robot.see();
      right.header.frame_id = "other";
      drive.robot.publish(left, right);
      drive.odometryOf(left.header.stamp);
    }
    const ros::Time stamp = drive.robot.drive(leaveOut);
    EXPECT_TRUE(waitUntil([&] {
      return !drive.log
                  .with(
                      "dropped (frame_id_missing, 1 so far): the left image has an empty "
                      "frame_id: set it in the driver, or set the parameter camera_frame")
                  .empty();
    }));
    EXPECT_FALSE(drive.robot.odometryOf(stamp, std::chrono::milliseconds(0)));
  }
  NodeletDrive drive({{"camera_frame", "camera_left"}});
  drive.setUp();
  drive.statusOf(drive.robot.drive(leaveOut));
  EXPECT_EQ(drive.statusOf(drive.robot.drive(leaveOut)).state, OdometryStatus::OK);
}

/// The mount is calibrated while the odometry runs: the camera looks to the left.
TEST(MovingMountTest, AResetTakesANewFixedMount) {
  NodeletDrive drive;
  drive.setUp();
  const auto position = [&] { return drive.odometryOf(drive.robot.drive()).pose.pose.position; };
  EXPECT_TRUE(waitUntil([&] { return position().x > 1.0; }));
  geometry_msgs::TransformStamped mount;
  mount.header.frame_id = "base_link";
  mount.child_frame_id = "camera_left";
  mount.transform.rotation.x = -M_SQRT1_2;
  mount.transform.rotation.w = M_SQRT1_2;
  tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(mount);
  EXPECT_LT(std::abs(position().y), 0.1) << "not before";
  std_srvs::Trigger reset;
  ASSERT_TRUE(drive.services.call("reset", reset));
  geometry_msgs::Point last;
  EXPECT_TRUE(waitUntil([&] {
    drive.robot.drive();
    last = position();
    return last.y > 1.0;
  }));
  EXPECT_LT(std::abs(last.x), 0.1);
}

}  // namespace
}  // namespace rotrocc
