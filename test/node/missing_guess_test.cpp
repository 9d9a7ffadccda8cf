// A guess_frame that does not exist, until the other odometry is started.

#include <map>
#include <mutex>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

/// The latest entry of /diagnostics on tf.
class TfDiagnostics {
 public:
  TfDiagnostics() {
    subscriber_ = ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          for (const auto& status : message->status) {
            if (status.name == "stereo_odometry: tf") text_ = status.message;
          }
        });
  }

  std::string text() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_;
  ros::Subscriber subscriber_;
};

geometry_msgs::TransformStamped wheelOdometry(const ros::Time& stamp, int pair) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = stamp;
  transform.header.frame_id = "wheel_odom";
  transform.child_frame_id = "base_link";
  transform.transform.translation.x = SimulatedRobot::kStep_m * pair;
  transform.transform.rotation.w = 1.0;
  return transform;
}

TEST(MissingGuessTest, IsToldCountedAndTriedAgain) {
  ros::AsyncSpinner spinner(2);
  spinner.start();
  const TfDiagnostics diagnostics;
  SimulatedRobot robot;
  robot.publishMount();
  robot.publishInfos();
  const auto drive = [&] {
    const ros::Time stamp = robot.drive();
    const auto status = robot.statusOf(stamp);
    EXPECT_TRUE(status);
    return status.value_or(OdometryStatus());
  };
  const std::string told = "no tf from guess_frame wheel_odom to base_link";
  OdometryStatus status;
  for (int pair = 0; pair < 10; ++pair) status = drive();
  EXPECT_EQ(status.state, OdometryStatus::OK) << status.reason;
  ASSERT_EQ(status.hint.find(told), 0u) << status.hint;
  EXPECT_EQ(status.guess_misses, 9u) << "all but the first pair";
  EXPECT_TRUE(waitUntil([&] { return diagnostics.text().find(told) == 0; })) << diagnostics.text();

  tf2_ros::TransformBroadcaster wheels;
  int pair = 0;
  EXPECT_TRUE(waitUntil([&] {
    auto [left, right] = robot.see();
    const ros::Time stamp = left.header.stamp;
    wheels.sendTransform(wheelOdometry(stamp, ++pair));
    robot.publish(left, right);
    status = robot.statusOf(stamp).value_or(OdometryStatus());
    return status.hint.empty();
  }));
  EXPECT_GE(status.guess_misses, 9u);
  EXPECT_TRUE(waitUntil([&] { return diagnostics.text() == "no conflict"; })) << diagnostics.text();
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "missing_guess_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
