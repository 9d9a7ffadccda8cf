// The node, from odometry to markers and the frame that rviz looks from.

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

namespace rotrocc {
namespace {

TEST(RvizSceneTest, MakesMarkersAndAFrame) {
  ros::NodeHandle nh;
  tf2_ros::Buffer tf;
  const tf2_ros::TransformListener listener(tf);
  visualization_msgs::MarkerArray::ConstPtr scene;
  const boost::function<void(const visualization_msgs::MarkerArray::ConstPtr&)> keep =
      [&](const visualization_msgs::MarkerArray::ConstPtr& markers) { scene = markers; };
  const ros::Subscriber subscriber = nh.subscribe("/stereo/scene", 1, keep);
  const ros::Publisher odom = nh.advertise<nav_msgs::Odometry>("/stereo/odom", 1);

  nav_msgs::Odometry odometry;
  odometry.header.frame_id = "odom";
  odometry.pose.pose.orientation.w = 1.0;
  while (ros::ok() && !(scene && tf.canTransform("odom", "trajectory_view", ros::Time()))) {
    odometry.header.stamp = ros::Time::now();
    odom.publish(odometry);
    ros::spinOnce();
    ros::WallDuration(0.05).sleep();
  }
  ASSERT_TRUE(scene);
  EXPECT_FALSE(scene->markers.empty());
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "rviz_scene_test");
  return RUN_ALL_TESTS();
}
