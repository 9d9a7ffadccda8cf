// The odometry as a node: it gets its images through a transport, on remapped topics.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include "support/simulated_robot.h"

namespace rotrocc {
namespace {

void invert(sensor_msgs::Image& image) {
  for (std::uint8_t& level : image.data) level = static_cast<std::uint8_t>(255 - level);
}

TEST(NodeTest, NamesAreRemappedBeforeTheTransportIsAppended) {
  SimulatedRobot robot;
  std::atomic<int> pictures{0};
  const ros::Subscriber flow = ros::NodeHandle().subscribe<sensor_msgs::Image>(
      "rig/flow/negative", 10, [&](const sensor_msgs::Image::ConstPtr&) { ++pictures; });
  robot.publishInfos();
  robot.publishMount();
  EXPECT_TRUE(waitUntil([&] {
    const auto status = robot.statusOf(robot.drive(invert));
    return status && status->state == OdometryStatus::OK && pictures > 0;
  }));
}

TEST(NodeTest, SwappedTopicsAreRemappedOnce) {
  std::mutex mutex;
  std::string reason;
  const ros::Subscriber status = ros::NodeHandle().subscribe<OdometryStatus>(
      "swapped/status", 10, [&](const OdometryStatus::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        reason = message->reason;
      });
  // The left images come first, if both are missing.
  EXPECT_TRUE(waitUntil([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return reason.find("/swapped/right/image_rect") != std::string::npos;
  }));
}

}  // namespace
}  // namespace rotrocc
