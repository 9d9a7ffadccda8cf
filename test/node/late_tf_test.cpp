// A robot whose tf comes 20 s after its images: longer than tf2 remembers.

#include <mutex>
#include <string>
#include <thread>
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

constexpr seconds kDelay{20};
constexpr seconds kWarningPeriod{5};

/// What the odometry warns of.
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
  robot.publishInfos();
  const Clock::time_point start = Clock::now();
  const ros::Time first = robot.drive();
  ros::Time last = first;
  while (Clock::now() < start + kDelay) {
    std::this_thread::sleep_for(milliseconds(100));
    last = robot.drive();
  }
  EXPECT_FALSE(robot.odometryOf(first, milliseconds(0)));
  EXPECT_FALSE(robot.odometryOf(last, milliseconds(0)));
  const auto waiting = robot.statusWith(OdometryStatus::NO_TF);
  ASSERT_TRUE(waiting);
  const std::string what = "no tf from base_link to camera_left";
  EXPECT_NE(waiting->reason.find(what), std::string::npos) << waiting->reason;
  // From some seconds after the start on.
  EXPECT_GE(warnings.countOf(what), 2);
  EXPECT_LE(warnings.countOf(what), 1 + (Clock::now() - start) / kWarningPeriod);

  // The newest pair has waited; those before it are gone.
  robot.publishMount();
  const auto odometry = robot.odometryOf(last);
  ASSERT_TRUE(odometry);
  EXPECT_EQ(odometry->pose.pose.position.x, 0.0);
  EXPECT_FALSE(robot.odometryOf(first, milliseconds(0)));
  const auto next = robot.odometryOf(robot.drive());
  ASSERT_TRUE(next);
  EXPECT_NEAR(next->pose.pose.position.x, SimulatedRobot::kStep_m, 0.02);
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "late_tf_test");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
