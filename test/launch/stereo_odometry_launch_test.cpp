// What stereo_odometry.launch and kitti.launch set, for the arguments that users give.

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "launch/launched.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

const std::string kNode = "/camera/stereo_odometry";

/// stereo_odometry.launch with a configuration file of `yaml`.
class StereoOdometryLaunchTest : public ::testing::Test {
 protected:
  Launched launch(const std::string& options = "") const {
    std::ofstream(path_) << "odom_frame: world\nbase_frame: body\npublish_tf: false\nplanar: true\n"
                            "guess_frame: wheels\nrectify: true\nmax_stamp_difference_s: 0.02\n"
                            "image_transport: compressed\ntrajectory_file: /tmp/of_yaml.txt\n"
                            "trajectory_format: kitti\n";
    return Launched("stereo_odometry.launch", "stereo:=/camera config:=" + path_ + " " + options);
  }

  TemporaryDirectory directory_;
  const std::string path_ = directory_ / "robot.yaml";
};

TEST_F(StereoOdometryLaunchTest, TheConfigurationFileHolds) {
  const Launched launched = launch();
  EXPECT_EQ(launched.param(kNode + "/odom_frame"), "world");
  EXPECT_EQ(launched.param(kNode + "/base_frame"), "body");
  EXPECT_FALSE(launched.param<bool>(kNode + "/publish_tf"));
  EXPECT_TRUE(launched.param<bool>(kNode + "/planar"));
  EXPECT_EQ(launched.param(kNode + "/guess_frame"), "wheels");
  EXPECT_TRUE(launched.param<bool>(kNode + "/rectify"));
  EXPECT_EQ(launched.param<double>(kNode + "/max_stamp_difference_s"), 0.02);
  EXPECT_EQ(launched.param(kNode + "/image_transport"), "compressed");
  EXPECT_EQ(launched.param(kNode + "/trajectory_file"), "/tmp/of_yaml.txt");
  EXPECT_EQ(launched.param(kNode + "/trajectory_format"), "kitti");
}

TEST_F(StereoOdometryLaunchTest, ArgumentsOverrideIt) {
  const Launched launched = launch(
      "odom_frame:=odom base_frame:=base_link publish_tf:=true planar:=false "
      "guess_frame:=wheel_odom rectify:=false "
      "max_stamp_difference_s:=0.005 image_transport:=raw trajectory_file:=/tmp/arg.txt "
      "trajectory_format:=tum");
  EXPECT_EQ(launched.param(kNode + "/odom_frame"), "odom");
  EXPECT_EQ(launched.param(kNode + "/base_frame"), "base_link");
  EXPECT_TRUE(launched.param<bool>(kNode + "/publish_tf"));
  EXPECT_FALSE(launched.param<bool>(kNode + "/planar"));
  EXPECT_EQ(launched.param(kNode + "/guess_frame"), "wheel_odom");
  EXPECT_FALSE(launched.param<bool>(kNode + "/rectify"));
  EXPECT_EQ(launched.param<double>(kNode + "/max_stamp_difference_s"), 0.005);
  EXPECT_EQ(launched.param(kNode + "/image_transport"), "raw");
  EXPECT_EQ(launched.param(kNode + "/trajectory_file"), "/tmp/arg.txt");
  EXPECT_EQ(launched.param(kNode + "/trajectory_format"), "tum");
}

TEST_F(StereoOdometryLaunchTest, WithoutAFileTheDefaultsHold) {
  const Launched launched("stereo_odometry.launch", "stereo:=/camera");
  EXPECT_EQ(launched.param(kNode + "/odom_frame"), "odom");
  EXPECT_EQ(launched.param(kNode + "/base_frame"), "base_link");
  EXPECT_TRUE(launched.param<bool>(kNode + "/publish_tf"));
}

TEST_F(StereoOdometryLaunchTest, ParametersOfAnEarlierRunAreDeleted) {
  EXPECT_TRUE(launch().clears(kNode + "/"));
  const Launched kitti("kitti.launch", "bag:=any.bag rviz:=false");
  EXPECT_TRUE(kitti.clears("/stereo/stereo_odometry/"));
  EXPECT_TRUE(kitti.clears("/stereo/kitti_player/"));
}

TEST_F(StereoOdometryLaunchTest, TopicsLandInTheNamespaceOfTheCamera) {
  const Launched launched = launch();
  for (const std::string topic : {"odom", "twist", "path", "status", "inliers", "flow"}) {
    EXPECT_EQ(launched.topic(kNode, topic), topic);
  }
}

TEST_F(StereoOdometryLaunchTest, TopicsLandWhereTheUserWants) {
  const Launched elsewhere = launch("output_ns:=/vo");
  for (const std::string topic : {"odom", "twist", "path", "status", "inliers", "flow"}) {
    EXPECT_EQ(elsewhere.topic(kNode, topic), "/vo/" + topic);
  }
  const Launched renamed = launch("output_ns:=vo odom_topic:=/odometry/visual rviz:=true");
  EXPECT_EQ(renamed.topic(kNode, "odom"), "/odometry/visual");
  EXPECT_EQ(renamed.topic(kNode, "path"), "vo/path");
  EXPECT_EQ(renamed.topic("/camera/rviz", "odom"), "/odometry/visual") << "rviz shows nothing";
}

TEST_F(StereoOdometryLaunchTest, ImagesComeFromWhereTheUserSays) {
  for (const std::string image : {"image_rect", "image_raw"}) {
    EXPECT_EQ(launch().topic(kNode, "left/" + image), "left/" + image);
    const Launched named = launch("left_image:=cam0/image right_image:=/cam1/image");
    EXPECT_EQ(named.topic(kNode, "left/" + image), "cam0/image");
    EXPECT_EQ(named.topic(kNode, "right/" + image), "/cam1/image");
  }
}

TEST_F(StereoOdometryLaunchTest, AGyroscopeIsUsedIfItsTopicIsGiven) {
  const Launched launched = launch("imu:=/imu/data");
  EXPECT_TRUE(launched.param<bool>(kNode + "/use_imu"));
  EXPECT_EQ(launched.topic(kNode, "imu"), "/imu/data");
  EXPECT_EQ(launch().topic(kNode, "imu"), "imu");
}

TEST_F(StereoOdometryLaunchTest, RvizShowsTheOdometryFrame) {
  const std::string given = launch("rviz:=true odom_frame:=map").property("/camera/rviz", "args");
  EXPECT_NE(given.find("-f map"), std::string::npos) << given;
  const std::string none = launch("rviz:=true").property("/camera/rviz", "args");
  EXPECT_EQ(none.find("-f"), std::string::npos) << none;
}

TEST(KittiLaunchFileTest, PlayerAndOdometryAgreeOnRawImages) {
  const Launched launched("kitti.launch", "bag:=any.bag rviz:=false rectify:=true");
  EXPECT_TRUE(launched.param<bool>("/stereo/stereo_odometry/rectify"));
  EXPECT_TRUE(launched.param<bool>("/stereo/kitti_player/rectify"));
}

TEST(KittiLaunchFileTest, TheConfigurationFileHolds) {
  const TemporaryDirectory directory;
  const std::string path = directory / "robot.yaml";
  std::ofstream(path) << "trajectory_file: /tmp/of_yaml.txt\ntrajectory_format: kitti\n";
  const Launched launched("kitti.launch", "bag:=any.bag rviz:=false config:=" + path);
  EXPECT_EQ(launched.param("/stereo/stereo_odometry/trajectory_file"), "/tmp/of_yaml.txt");
  EXPECT_EQ(launched.param("/stereo/stereo_odometry/trajectory_format"), "kitti");
}

}  // namespace
}  // namespace rotrocc
