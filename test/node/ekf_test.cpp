// ekf.launch: the odometry as input of ekf_localization_node, in simulated time.

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include "support/background_command.h"
#include "support/run_command.h"
#include "support/simulated_robot.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr double kSpeed_mps = SimulatedRobot::kStep_m / SimulatedRobot::kPeriod_s;
/// Of way and speed, by odometry and filter together.
constexpr double kWayError = 0.01;
constexpr double kTick_s = 0.01;

class EkfTest : public testing::Test {
 protected:
  EkfTest()
      : clock_(ros::NodeHandle().advertise<rosgraph_msgs::Clock>("/clock", 1000)),
        now_(1000.0),
        buffer_(ros::Duration(100.0)),
        listener_(buffer_),
        output_(ros::NodeHandle().subscribe<nav_msgs::Odometry>(
            "/odometry/filtered", 1000, [this](const nav_msgs::Odometry::ConstPtr& message) {
              const std::lock_guard<std::mutex> lock(mutex_);
              filtered_[message->header.stamp] = *message;
            })) {}

  /// Drives and publishes, and waits for the odometry.
  ros::Time drive(SimulatedRobot& robot, bool dark = false) {
    const ros::Time stamp = robot.drive([dark](sensor_msgs::Image& image) {
      if (dark) std::fill(image.data.begin(), image.data.end(), 0);
    });
    EXPECT_TRUE(robot.odometryOf(stamp));
    waitForPeriod();
    return stamp;
  }

  /// Drives on without images.
  ros::Time driveBlind(SimulatedRobot& robot) {
    const ros::Time stamp = robot.see().first.header.stamp;
    waitForPeriod();
    return stamp;
  }

  /// Lets the time of the robot pass, in which the filter works.
  void waitForPeriod() {
    for (int i = 0; i < std::lround(SimulatedRobot::kPeriod_s / kTick_s); ++i) tick();
  }

  void tick() {
    now_ += ros::Duration(kTick_s);
    rosgraph_msgs::Clock message;
    message.clock = now_;
    clock_.publish(message);
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }

  /// The first output of the filter from that time on; an empty message if there is none.
  nav_msgs::Odometry outputFrom(const ros::Time& stamp) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = filtered_.lower_bound(stamp);
    return found == filtered_.end() ? nav_msgs::Odometry() : found->second;
  }

  /// The output of the filter from that time on, for which the time may go on.
  nav_msgs::Odometry filteredFrom(const ros::Time& stamp) {
    nav_msgs::Odometry message;
    EXPECT_TRUE(waitUntil([&] {
      message = outputFrom(stamp);
      if (message.header.stamp.isZero()) tick();
      return !message.header.stamp.isZero();
    })) << "no output from "
        << stamp;
    return message;
  }

  /// The speed is constant, so predictions are as good as measurements.
  void expectOnTheWay(const nav_msgs::Odometry& filtered) const {
    const double way_m = kSpeed_mps * (filtered.header.stamp - start_.header.stamp).toSec();
    const double filtered_m = filtered.pose.pose.position.x - start_.pose.pose.position.x;
    EXPECT_NEAR(filtered_m, way_m, kWayError * way_m) << filtered.header.stamp;
    EXPECT_NEAR(filtered.twist.twist.linear.x, kSpeed_mps, kWayError * kSpeed_mps);
  }

  static double sigma(const nav_msgs::Odometry& filtered) {
    return std::sqrt(filtered.pose.covariance[0]);
  }

  ros::Publisher clock_;
  ros::Time now_;
  nav_msgs::Odometry start_;  // the first output
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  std::mutex mutex_;
  std::map<ros::Time, nav_msgs::Odometry> filtered_;  // by stamp
  ros::Subscriber output_;
};

TEST_F(EkfTest, FollowsTheRobotThroughLostMotionAndAGap) {
  const CommandResult nodes = runCommand("roslaunch --nodes rotrocc ekf.launch");
  if (nodes.status != 0) GTEST_SKIP() << "needs the package robot_localization";
  const TemporaryDirectory directory;
  const BackgroundCommand launch(
      "env -u ROS_NAMESPACE roslaunch rotrocc ekf.launch stereo:=/stereo", directory / "log");
  SimulatedRobot robot;
  ASSERT_TRUE(waitUntil([&] { return output_.getNumPublishers() > 0; }));
  robot.publishMount();
  robot.publishInfos();
  tick();

  // The filter may still be connecting.
  ros::Time last = drive(robot);
  ASSERT_TRUE(waitUntil([&] {
    last = drive(robot);
    start_ = outputFrom(ros::Time(1.0));
    return !start_.header.stamp.isZero();
  }));
  for (int i = 0; i < 10; ++i) last = drive(robot);
  // A motion has the stamp of the pair before it.
  nav_msgs::Odometry filtered = filteredFrom(last - ros::Duration(1.5 * SimulatedRobot::kPeriod_s));
  expectOnTheWay(filtered);
  const double sigma_m = sigma(filtered);
  EXPECT_LT(sigma_m, 0.2);
  const auto pose = buffer_.lookupTransform("odom", "base_link", filtered.header.stamp);
  EXPECT_NEAR(pose.transform.translation.x, filtered.pose.pose.position.x, 1e-6);

  // Its zero twist must not slow down the filter.
  for (int i = 0; i < 8; ++i) last = drive(robot, true);
  EXPECT_EQ(robot.statusOf(last)->state, OdometryStatus::LOST);
  expectOnTheWay(filteredFrom(last));
  for (int i = 0; i < 5; ++i) last = drive(robot);
  expectOnTheWay(filteredFrom(last - ros::Duration(1.5 * SimulatedRobot::kPeriod_s)));

  for (int i = 0; i < 30; ++i) last = driveBlind(robot);
  filtered = filteredFrom(last);
  expectOnTheWay(filtered);
  // sqrt(10 m^2/s^3 * t^3 / 3), the process noise, after 3 s.
  EXPECT_GT(sigma(filtered), 9.0);

  for (int i = 0; i < 10; ++i) last = drive(robot);
  filtered = filteredFrom(last + ros::Duration(1.0));
  expectOnTheWay(filtered);
  EXPECT_GT(sigma(filtered), 1.0);
}

TEST_F(EkfTest, LaunchSaysHowToGetAMissingFilter) {
  const CommandResult launch =
      runCommand("ROS_PACKAGE_PATH=" ROTROCC_SOURCE_DIR " roslaunch rotrocc ekf.launch");
  EXPECT_NE(launch.status, 0);
  EXPECT_NE(launch.output.find("apt install ros-noetic-robot-localization"), std::string::npos)
      << launch.output;
}

}  // namespace
}  // namespace rotrocc
