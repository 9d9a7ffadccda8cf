// What is published while the motion is lost.

#include <algorithm>
#include <cmath>

#include <tf2_msgs/TFMessage.h>

#include "nodelet_drive.h"

namespace rotrocc {
namespace {

void makeBlack(sensor_msgs::Image& image) {
  std::fill(image.data.begin(), image.data.end(), 0);
}

TEST(WhileLostTest, WhatIsPublishedIsWhatIsAskedFor) {
  for (const std::string while_lost : {"hold", "silent", "unknown"}) {
    SCOPED_TRACE(while_lost);
    NodeletDrive drive({{"while_lost", while_lost}});
    Received<tf2_msgs::TFMessage> tf("/tf");
    const auto hasTf = [&](const ros::Time& stamp) {
      const auto& all = tf.all();
      return std::any_of(all.begin(), all.end(), [&](const auto& message) {
        return message->transforms.front().header.stamp == stamp;
      });
    };
    drive.setUp();
    ros::Time stamp;
    EXPECT_TRUE(waitUntil([&] {
      stamp = drive.robot.drive();
      return drive.odometryOf(stamp).pose.pose.position.x > 1.0 && hasTf(stamp);
    }));
    const double held_m = drive.odometryOf(stamp).pose.pose.position.x;
    const ros::Time lost = drive.robot.drive(makeBlack);
    EXPECT_EQ(drive.statusOf(lost).state, OdometryStatus::LOST);
    EXPECT_EQ(hasTf(lost), while_lost == "hold");
    const auto odometry = drive.robot.odometryOf(lost, kSoon);
    ASSERT_EQ(odometry.has_value(), while_lost != "silent");
    if (odometry) {
      const bool is_unknown = while_lost == "unknown";
      EXPECT_EQ(odometry->pose.pose.position.x, is_unknown ? 0.0 : held_m);
      EXPECT_EQ(odometry->pose.covariance[0] == 9999.0, is_unknown);
      EXPECT_EQ(odometry->twist.covariance[0], 9999.0);
      const double way_m = SimulatedRobot::kStep_m;  // at the last speed
      EXPECT_TRUE(is_unknown || std::sqrt(odometry->pose.covariance[0]) < 1.2 * way_m);
      EXPECT_EQ(odometry->header.frame_id, "odom");
    }
    stamp = drive.robot.drive();
    EXPECT_GT(drive.odometryOf(stamp).pose.pose.position.x, held_m);
    EXPECT_TRUE(hasTf(stamp));
  }
}

}  // namespace
}  // namespace rotrocc
