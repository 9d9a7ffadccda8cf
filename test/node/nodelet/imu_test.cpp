// A robot with a gyroscope that drives straight on: the gyroscope is used, missing, late, wrong,
// and used again.

#include <cmath>
#include <limits>
#include <string>

#include <sensor_msgs/Imu.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_broadcaster.h>

#include "input/message_conversion.h"
#include "node/odometry_messages.h"
#include "nodelet_drive.h"
#include "sequences/kitti_mount.h"

namespace rotrocc {
namespace {

constexpr double kSample_s = 0.005;
constexpr int kSamplesPerPair = 20;
constexpr double kSwing_rad = 0.05;  // per pair

class ImuTest : public testing::Test {
 protected:
  ImuTest() {
    publisher_ = ros::NodeHandle().advertise<sensor_msgs::Imu>("imu", 1000);
    EXPECT_TRUE(waitUntil([&] { return publisher_.getNumSubscribers() > 0; }));
    drive_.robot.publishInfos();
  }

  void publishImuFrame(const Eigen::Isometry3d& T_base_imu = Eigen::Isometry3d::Identity()) {
    drive_.robot.publishStatic(toTransform(T_base_imu, 0, "base_link", "imu_link"));
  }

  /// Drives a step. The samples up to the pair are published before it. Returns its stamp.
  ros::Time see(double yaw_rate_rps) {
    const auto [left, right] = drive_.robot.see();
    publishSamples(left.header.stamp, yaw_rate_rps);
    drive_.robot.publish(left, right);
    return left.header.stamp;
  }

  OdometryStatus drive(double yaw_rate_rps) { return drive_.statusOf(see(yaw_rate_rps)); }

  /// Drives a step while the camera turns on a head, to and fro, whose tf comes after the images.
  OdometryStatus driveWithHead() {
    drive_.robot.look(left_rad_ += pairs_++ / 8 % 2 == 0 ? kSwing_rad : -kSwing_rad);
    const ros::Time stamp = see(0.0);
    Eigen::Isometry3d T_base_camera(Eigen::AngleAxisd(left_rad_, Eigen::Vector3d::UnitZ()));
    T_base_camera.rotate(kittiMount().linear());
    std::optional<OdometryStatus> status;
    EXPECT_TRUE(waitUntil([&] {  // the first transforms may be lost
      joints_.sendTransform(
          toTransform(T_base_camera, toNanoseconds(stamp), "base_link", "camera_left"));
      status = drive_.robot.statusOf(stamp, std::chrono::milliseconds(100));
      return status.has_value();
    }));
    return status.value_or(OdometryStatus());
  }

  OdometryStatus driveWithout() { return drive_.statusOf(drive_.robot.drive()); }

  void publishSamples(const ros::Time& pair, double yaw_rate_rps) {
    for (int i = 1 - kSamplesPerPair; i <= 1; ++i) {
      publishSample(pair + ros::Duration((i - 0.5) * kSample_s), yaw_rate_rps);
    }
  }

  void publishSample(const ros::Time& stamp, double yaw_rate_rps) {
    if (stamp <= last_sample_) return;
    last_sample_ = stamp;
    sensor_msgs::Imu message;
    message.header.stamp = stamp;
    message.header.frame_id = frame_;
    message.angular_velocity.z = yaw_rate_rps;
    message.linear_acceleration.x = acceleration_.x();
    message.linear_acceleration.y = acceleration_.y();
    message.linear_acceleration.z = acceleration_.z();
    message.linear_acceleration_covariance[0] = acceleration_.isZero() ? -1.0 : 0.0;
    publisher_.publish(message);
  }

  /// The odometry of a first pair, after samples of a second up to it.
  nav_msgs::Odometry begin() {
    const auto [left, right] = drive_.robot.see();
    const ros::Time stamp = left.header.stamp;
    for (int i = -200; i <= 1; ++i) publishSample(stamp + ros::Duration(i * kSample_s), 0.02);
    drive_.robot.publish(left, right);
    return drive_.odometryOf(stamp);
  }

  /// The vertical of odom in axes of the base.
  static Eigen::Vector3d upOf(const nav_msgs::Odometry& odometry) {
    const geometry_msgs::Quaternion& q = odometry.pose.pose.orientation;
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).inverse() * Eigen::Vector3d::UnitZ();
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

  // It waits longer for tf than the load of a machine delays it.
  NodeletDrive drive_{{{"use_imu", true}, {"transform_timeout_s", 5.0}}};
  ros::Publisher publisher_;
  tf2_ros::TransformBroadcaster joints_;
  ros::Time last_sample_;
  std::string frame_ = "imu_link";
  Eigen::Vector3d acceleration_ = Eigen::Vector3d::Zero();  // none
  OdometryStatus last_;
  double left_rad_ = 0.0;
  int pairs_ = 0;
};

TEST_F(ImuTest, IsUsedWhenItIsThereAndToldWhenNot) {
  drive_.robot.publishMount();
  const auto biased = [&] { return drive(0.02); };
  EXPECT_TRUE(drivesUntil("no message on /imu", [&] { return driveWithout(); }));
  EXPECT_TRUE(drivesUntil("no tf from 'imu_link', the frame of /imu, to base_link", biased));
  publishImuFrame();
  ASSERT_TRUE(drivesUntil("", biased));
  EXPECT_EQ(last_.state, OdometryStatus::OK);

  for (int pair = 0; pair < SourceWatch::kPairs; ++pair) biased();
  const auto told = [&] { return drive_.log.with("the gyroscope is not used").size(); };
  const std::size_t logged_before = told();

  // Without samples, the odometry continues, and is told why.
  EXPECT_TRUE(drivesUntil("older than the image", [&] { return driveWithout(); }));
  for (int pair = 0; pair < 10; ++pair) {
    const OdometryStatus status = driveWithout();
    EXPECT_EQ(status.state, OdometryStatus::OK) << status.reason;
  }
  EXPECT_EQ(told(), logged_before + 1) << "once for all of them";
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

TEST_F(ImuTest, LevelsTheFirstPoseAtRest) {
  drive_.robot.publishMount();
  frame_ = "base_link";
  acceleration_ = 9.8 * Eigen::Vector3d(0.1, -0.2, 0.9).normalized();
  const nav_msgs::Odometry first = begin();
  EXPECT_LT((upOf(first) - acceleration_.normalized()).norm(), 1e-3);
  EXPECT_NEAR(std::sqrt(first.pose.covariance[21]), 0.01, 1e-3);
  EXPECT_EQ(drive_.log.with("is not level").size(), 0u);
  // In motion, a reset cannot do it again. A pair waits for the samples up to it.
  for (int pair = 0; pair < 3; ++pair) drive(0.5);
  std_srvs::Trigger reset;
  ASSERT_TRUE(drive_.services.call("reset", reset));
  const nav_msgs::Odometry again = drive_.odometryOf(drive_.robot.drive());
  EXPECT_TRUE(upOf(again).isApprox(Eigen::Vector3d::UnitZ(), 1e-9));
  EXPECT_EQ(drive_.log.with("the first pose is not level: the robot is not at rest").size(), 1u);
}

/// The camera turns, and the base with the gyroscope does not.
TEST_F(ImuTest, TheTurnsOfAHeadAreNoBias) {
  publishImuFrame();
  const auto turn = [&] { return driveWithHead(); };
  ASSERT_TRUE(drivesUntil("", turn));
  for (int pair = 0; pair < 24; ++pair) {
    const OdometryStatus status = turn();
    EXPECT_EQ(status.imu_reason, "");
    EXPECT_EQ(status.state, OdometryStatus::OK) << status.reason;
  }
}

}  // namespace
}  // namespace rotrocc
