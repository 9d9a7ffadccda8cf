// A robot with a gyroscope that drives straight on: the gyroscope is used, missing, late, wrong,
// and used again.

#include <cmath>
#include <limits>
#include <string>

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

constexpr double kSample_s = 0.005;
constexpr int kSamplesPerPair = 20;

class ImuTest : public testing::Test {
 protected:
  ImuTest() {
    publisher_ = ros::NodeHandle().advertise<sensor_msgs::Imu>("imu", 1000);
    EXPECT_TRUE(waitUntil([&] { return publisher_.getNumSubscribers() > 0; }));
    robot_.publishMount();
    robot_.publishInfos();
  }

  void publishImuFrame() {
    geometry_msgs::TransformStamped mount;
    mount.header.frame_id = "base_link";
    mount.child_frame_id = "imu_link";
    mount.transform.rotation.w = 1.0;
    broadcaster_.sendTransform(mount);
  }

  /// Drives a step. The samples up to the pair are published before it, plus a bias in yaw.
  std::optional<OdometryStatus> drive(double yaw_rate_rps) {
    const auto [left, right] = robot_.see();
    for (int i = 1 - kSamplesPerPair; i <= 1; ++i) {
      publishSample(left.header.stamp + ros::Duration((i - 0.5) * kSample_s), yaw_rate_rps);
    }
    robot_.publish(left, right);
    return robot_.statusOf(left.header.stamp);
  }

  std::optional<OdometryStatus> driveWithout() { return robot_.statusOf(robot_.drive()); }

  void publishSample(const ros::Time& stamp, double yaw_rate_rps) {
    if (stamp <= last_sample_) return;
    last_sample_ = stamp;
    sensor_msgs::Imu message;
    message.header.stamp = stamp;
    message.header.frame_id = "imu_link";
    message.angular_velocity.z = yaw_rate_rps;
    publisher_.publish(message);
  }

  /// Drives, with `drive`, until the gyroscope is used or not for a reason.
  template <typename Drive>
  bool drivesUntil(const std::string& reason, const Drive& drive) {
    for (int pair = 0; pair < 40; ++pair) {
      const std::optional<OdometryStatus> status = drive();
      if (!status) return false;
      last_ = *status;
      const bool is_it = reason.empty()
                             ? status->imu_reason.empty() && status->rotations_predicted > 0
                             : status->imu_reason.find(reason) != std::string::npos;
      if (is_it) return true;
    }
    ADD_FAILURE() << "'" << last_.imu_reason << "' is not '" << reason << "'";
    return false;
  }

  SimulatedRobot robot_;
  ros::Publisher publisher_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  ros::Time last_sample_;
  OdometryStatus last_;
};

TEST_F(ImuTest, IsUsedWhenItIsThereAndToldWhenNot) {
  const auto biased = [&] { return drive(0.02); };
  EXPECT_TRUE(drivesUntil("no message on /imu", [&] { return driveWithout(); }));
  EXPECT_TRUE(drivesUntil("no tf from 'imu_link', the frame of /imu, to camera_left", biased));
  publishImuFrame();
  ASSERT_TRUE(drivesUntil("", biased));
  EXPECT_EQ(last_.state, OdometryStatus::OK);

  // Without samples, the odometry goes on, and is told why.
  EXPECT_TRUE(drivesUntil("older than the image", [&] { return driveWithout(); }));
  for (int pair = 0; pair < 10; ++pair) {
    const auto status = driveWithout();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->state, OdometryStatus::OK) << status->reason;
  }
  ASSERT_TRUE(drivesUntil("", biased));

  EXPECT_TRUE(drivesUntil("the angular velocity is not a number",
                          [&] { return drive(std::numeric_limits<double>::quiet_NaN()); }));
  ASSERT_TRUE(drivesUntil("", biased));

  // A gyroscope that turns when the robot does not: as one in degrees, or of other axes.
  const std::uint64_t before = last_.rotations_missed;
  EXPECT_TRUE(drivesUntil("differ from those of the images", [&] { return drive(2.0); }));
  EXPECT_GT(last_.rotations_missed, before);
  EXPECT_EQ(last_.state, OdometryStatus::OK) << last_.reason;
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "imu_test");
  ros::AsyncSpinner spinner(2);
  const ros::NodeHandle keeps_ros_alive;
  spinner.start();
  return RUN_ALL_TESTS();
}
