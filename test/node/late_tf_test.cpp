// A robot whose camera_info arrives late, and its tf later than the buffer length of tf2.

#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

constexpr double kTfMemory_s = 10.0;
constexpr seconds kWarningPeriod{5};

/// The warnings of the odometry.
class Warnings {
 public:
  Warnings() {
    subscriber_ = ros::NodeHandle().subscribe<rosgraph_msgs::Log>(
        "/rosout", 100, [this](const rosgraph_msgs::Log::ConstPtr& message) {
          if (message->level != rosgraph_msgs::Log::WARN || message->name != "/stereo_odometry")
            return;
          const std::lock_guard<std::mutex> lock(mutex_);
          texts_.push_back(message->msg);
        });
  }

  int countOf(const std::string& part) {
    const std::lock_guard<std::mutex> lock(mutex_);
    int count = 0;
    for (const std::string& text : texts_) count += text.find(part) != std::string::npos;
    return count;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> texts_;
  ros::Subscriber subscriber_;
};

TEST(LateTfTest, OdometryWaitsAndStartsByItself) {
  ros::AsyncSpinner spinner(2);
  spinner.start();
  Warnings warnings;
  SimulatedRobot robot;
  const Clock::time_point start = Clock::now();
  EXPECT_TRUE(robot.statusWith(OdometryStatus::NO_INPUT));
  const ros::Time first = robot.drive();
  EXPECT_TRUE(robot.statusWith(OdometryStatus::NO_CALIBRATION, "left/camera_info"));

  robot.publishInfos();
  const std::string missing = "no tf from base_link to camera_left";
  EXPECT_TRUE(waitUntil([&] {
    robot.drive();
    return robot.statusWith(OdometryStatus::NO_TF, missing, milliseconds(50)).has_value();
  }));
  EXPECT_TRUE(waitUntil(
      [&] {
        const ros::Duration length = robot.drive() - first;
        return length.toSec() > 2.0 * kTfMemory_s && warnings.countOf(missing) >= 2;
      },
      milliseconds(20)));
  EXPECT_LE(warnings.countOf(missing), 1 + (Clock::now() - start) / kWarningPeriod);
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
  const auto status = robot.statusOf(odometry->header.stamp);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->state, OdometryStatus::INITIALISING);

  ASSERT_TRUE(robot.odometryOf(robot.drive()));  // no other pair is pending
  const auto before = robot.odometryOf(robot.drive());
  const auto after = robot.odometryOf(robot.drive());
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(
      after->pose.pose.position.x - before->pose.pose.position.x, SimulatedRobot::kStep_m, 0.02);
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "late_tf_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
