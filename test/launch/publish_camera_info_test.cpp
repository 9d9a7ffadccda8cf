// The camera_info that publish_camera_info sends with the images of a camera without one.

#include <optional>

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "support/wait_until.h"

namespace rotrocc {
namespace {

TEST(PublishCameraInfoTest, HasTheStampOfTheImage) {
  ros::NodeHandle nh;
  std::optional<sensor_msgs::CameraInfo> info;
  const auto publisher = nh.advertise<sensor_msgs::Image>("cam1/image_raw", 1, true);
  const auto subscriber = nh.subscribe<sensor_msgs::CameraInfo>(
      "cam1/camera_info", 1, [&](const sensor_msgs::CameraInfo::ConstPtr& message) {
        info = *message;
      });
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(1403636580, 763555584);
  image.header.frame_id = "cam0";
  ASSERT_TRUE(waitUntil([&] {
    publisher.publish(image);
    ros::spinOnce();
    return info.has_value();
  }));
  EXPECT_EQ(info->header.stamp, image.header.stamp);
  EXPECT_EQ(info->header.frame_id, "cam0");
  EXPECT_EQ(info->width, 752u);
  EXPECT_EQ(info->D.at(0), -0.28368365);
  EXPECT_EQ(info->K[0], 457.587);
  EXPECT_NEAR(info->P[3] / -info->P[0], 0.110, 0.001);  // the baseline of the VI sensor
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  ros::init(argc, argv, "publish_camera_info_test");
  const ros::NodeHandle nh;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
