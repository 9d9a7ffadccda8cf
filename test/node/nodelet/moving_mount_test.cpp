// The pose and the frame of the camera: one that moves on a robot at rest, and another one in its
// place.

#include <thread>

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

/// A robot at rest whose camera moves on it.
class MovingCameraTest : public testing::Test {
 protected:
  /// It waits for tf for long, or hardly.
  void start(double transform_timeout_s) {
    drive_.emplace(RunningNodelet::Parameters{{"transform_timeout_s", transform_timeout_s}});
    drive_->robot.publishInfos();
  }

  /// A pair whose tf comes after the images; its first messages may be lost.
  void move() {
    const auto [left, right] = drive_->robot.see();
    drive_->robot.publish(left, right);
    const auto mount = mountAt(x_m_, left.header.stamp, "camera_left");
    x_m_ += SimulatedRobot::kStep_m;
    std::optional<nav_msgs::Odometry> at_rest;
    EXPECT_TRUE(waitUntil([&] {
      joints_.sendTransform(mount);
      at_rest = drive_->robot.odometryOf(mount.header.stamp, std::chrono::milliseconds(100));
      return at_rest.has_value();
    }));
    EXPECT_NEAR(at_rest->pose.pose.position.x, 0.0, 0.05);
    EXPECT_NEAR(at_rest->twist.twist.linear.x, 0.0, 0.2);
  }

  std::optional<NodeletDrive> drive_;
  tf2_ros::TransformBroadcaster joints_;
  double x_m_ = 1.0;
};

TEST_F(MovingCameraTest, TheBaseRestsWhileItsCameraMovesAlsoAfterATimeJump) {
  start(10.0);
  for (int pair = 0; pair < 6; ++pair) move();
  drive_->robot.setTime(ros::Time(900.0));
  for (int pair = 0; pair < 3; ++pair) move();

  // Now the base drives: its new camera is fixed, and where the other one was.
  tf2_ros::StaticTransformBroadcaster fixed;
  fixed.sendTransform(mountAt(x_m_, ros::Time(), "other_camera"));
  const auto driveWithOther = [&] {
    return drive_->odometryOf(drive_->robot.drive(
        [](sensor_msgs::Image& image) { image.header.frame_id = "other_camera"; }));
  };
  const double before_m = driveWithOther().pose.pose.position.x;
  nav_msgs::Odometry odometry;
  for (int pair = 0; pair < 3; ++pair) odometry = driveWithOther();
  EXPECT_NEAR(odometry.pose.pose.position.x - before_m, 3 * SimulatedRobot::kStep_m, 0.05);
  EXPECT_EQ(drive_->statusOf(odometry.header.stamp).header.frame_id, "other_camera");
}

TEST_F(MovingCameraTest, EndsWithoutWaitingForTf) {
  start(10.0);
  for (int pair = 0; pair < 3; ++pair) move();
  drive_->robot.drive();  // waits for its tf
  drive_->nodelet.finish();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const auto begin = std::chrono::steady_clock::now();
  drive_->nodelet.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST_F(MovingCameraTest, APairWithoutTfIsDroppedWithTheRateAndARemedy) {
  start(0.02);
  DiagnosticsListener diagnostics;
  const auto see = [&](bool has_tf) {
    const auto [left, right] = drive_->robot.see();
    if (has_tf) {
      joints_.sendTransform(mountAt(x_m_, left.header.stamp, "camera_left"));
      x_m_ += SimulatedRobot::kStep_m;
    }
    drive_->robot.publish(left, right);
    return left.header.stamp;
  };
  EXPECT_TRUE(waitUntil([&] { return drive_->robot.odometryOf(see(true), kSoon).has_value(); }));
  for (int pair = 0; pair < 6; ++pair) see(true);
  EXPECT_FALSE(drive_->robot.odometryOf(see(false), 5 * kSoon));
  const std::string said =
      "tf from base_link to camera_left, which moves, arrives at 10.0 Hz and more than "
      "transform_timeout_s = 0.02 s after the images: publish it earlier, or raise "
      "transform_timeout_s";
  EXPECT_TRUE(waitUntil([&] { return !drive_->log.with(said).empty(); }));
  EXPECT_TRUE(drive_->robot.statusWith(OdometryStatus::NO_TF, said)) << "while no pair has a pose";
  EXPECT_TRUE(waitUntil([&] {
    const auto status = drive_->robot.statusOf(see(true), kSoon);
    return status && status->hint.find(said) == 0;
  }));
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
TEST(CameraPoseTest, AResetTakesANewFixedMount) {
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
