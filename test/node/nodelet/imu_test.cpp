// A robot with a gyroscope that drives straight on: the gyroscope is used, missing, late, wrong,
// and used again.

#include <cmath>
#include <limits>
#include <string>

#include <sensor_msgs/Imu.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "node/odometry_messages.h"
#include "nodelet_drive.h"

namespace rotrocc {
namespace {

constexpr double kSample_s = 0.005;
constexpr int kSamplesPerPair = 20;

class ImuTest : public testing::Test {
 protected:
  ImuTest() {
    publisher_ = ros::NodeHandle().advertise<sensor_msgs::Imu>("imu", 1000);
    EXPECT_TRUE(waitUntil([&] { return publisher_.getNumSubscribers() > 0; }));
    drive_.setUp();
  }

  void publishImuFrame() {
    broadcaster_.sendTransform(
        toTransform(Eigen::Isometry3d::Identity(), 0, "base_link", "imu_link"));
  }

  /// Drives a step. The samples up to the pair are published before it, plus a bias in yaw.
  OdometryStatus drive(double yaw_rate_rps) {
    const auto [left, right] = drive_.robot.see();
    for (int i = 1 - kSamplesPerPair; i <= 1; ++i) {
      publishSample(left.header.stamp + ros::Duration((i - 0.5) * kSample_s), yaw_rate_rps);
    }
    drive_.robot.publish(left, right);
    return drive_.statusOf(left.header.stamp);
  }

  OdometryStatus driveWithout() { return drive_.statusOf(drive_.robot.drive()); }

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
      last_ = drive();
      if (reason.empty() ? last_.imu_reason.empty() && last_.rotations_predicted > 0
                         : last_.imu_reason.find(reason) != std::string::npos) {
        return true;
      }
    }
    ADD_FAILURE() << "'" << last_.imu_reason << "' is not '" << reason << "'";
    return false;
  }

  // It waits longer for a sample than the load of a machine delays one.
  NodeletDrive drive_{{{"use_imu", true}, {"imu_timeout_s", 1.0}}};
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

  for (int pair = 0; pair < GyroInput::kPairs; ++pair) biased();
  const auto told = [&] { return drive_.log.with("the gyroscope is not used").size(); };
  const std::size_t told_before = told();

  // Without samples, the odometry goes on, and is told why.
  EXPECT_TRUE(drivesUntil("older than the image", [&] { return driveWithout(); }));
  for (int pair = 0; pair < 10; ++pair) {
    const OdometryStatus status = driveWithout();
    EXPECT_EQ(status.state, OdometryStatus::OK) << status.reason;
  }
  EXPECT_EQ(told(), told_before + 1) << "once for all of them";
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
