// The node, from odometry to markers and the frame that rviz looks from.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

using visualization_msgs::MarkerArray;

class RvizSceneTest : public ::testing::Test {
 protected:
  /// Sends odometry of a robot that rests, with a speed that changes, until the node has sent what
  /// is asked for.
  bool restUntil(const std::function<bool()>& is_done) {
    nav_msgs::Odometry odometry;
    odometry.header.frame_id = "odom";
    odometry.pose.pose.orientation.w = 1.0;
    while (ros::ok() && !is_done()) {
      odometry.header.stamp = ros::Time::now();
      odometry.twist.twist.linear.x += 1.0;
      odom_.publish(odometry);
      ros::spinOnce();
      ros::WallDuration(0.05).sleep();
    }
    return ros::ok();
  }

  ros::Subscriber subscribe(MarkerArray& scene) {
    return nh_.subscribe<MarkerArray>(
        "/stereo/scene", 1, [&scene](const MarkerArray::ConstPtr& markers) { scene = *markers; });
  }

  static bool has(const MarkerArray& scene, const std::string& name) {
    return std::any_of(scene.markers.begin(), scene.markers.end(), [&](const auto& marker) {
      return marker.ns == name;
    });
  }

  ros::NodeHandle nh_;
  ros::Publisher odom_ = nh_.advertise<nav_msgs::Odometry>("/stereo/odom", 1);
};

TEST_F(RvizSceneTest, SendsWhatChangesAndEverythingToANewViewer) {
  MarkerArray scene;
  const ros::Subscriber first = subscribe(scene);
  EXPECT_TRUE(restUntil([&] { return has(scene, "estimate"); }));
  EXPECT_TRUE(restUntil([&] { return has(scene, "state") && !has(scene, "estimate"); }));
  MarkerArray scene_of_second;
  const ros::Subscriber second = subscribe(scene_of_second);
  EXPECT_TRUE(restUntil([&] { return has(scene_of_second, "estimate"); }));
}

TEST_F(RvizSceneTest, TheFrameOfTheViewIsThatOfTheNamespace) {
  tf2_ros::Buffer tf;
  const tf2_ros::TransformListener listener(tf);
  EXPECT_TRUE(
      restUntil([&] { return tf.canTransform("odom", "trajectory_view/stereo", ros::Time()); }));
}

/// With a program in the place of rviz that prints its arguments and the view.
TEST_F(RvizSceneTest, RvizGetsTheFramesOfTheOdometryInItsNamespace) {
  ros::param::set("/rear/stereo_odometry/odom_frame", "world");
  ros::param::set("/rear/stereo_odometry/base_frame", "body");
  const TemporaryDirectory directory;
  const std::string rviz = directory.write("rviz", "#!/bin/sh\necho $*\ncat $2\n");
  std::filesystem::permissions(rviz, std::filesystem::perms::owner_all);
  for (const std::string view : {"kitti", "stereo_odometry"}) {
    const CommandResult result =
        runCommand("PATH=" + directory / "" + ":$PATH ROS_HOME=" + directory / "" +
                   " ROS_NAMESPACE=rear " ROOT "/scripts/rig_view " ROOT "/rviz/" + view +
                   ".rviz odom:=visual");
    ASSERT_EQ(result.status, 0) << result.output;
    EXPECT_EQ(result.output.find("-d " + directory / "rotrocc_rear.rviz" + " odom:=visual\n"), 0u)
        << result.output;
    std::set<std::string> frames;
    const std::regex frame("(?:Fixed|Target|Reference) Frame: (.*)");
    for (std::sregex_iterator match(result.output.begin(), result.output.end(), frame), end;
         match != end;
         ++match) {
      frames.insert((*match)[1]);
    }
    EXPECT_EQ(frames, (std::set<std::string>{"body", "trajectory_view/rear", "world"})) << view;
  }
}

}  // namespace
}  // namespace rotrocc

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "rviz_scene_test");
  return RUN_ALL_TESTS();
}
