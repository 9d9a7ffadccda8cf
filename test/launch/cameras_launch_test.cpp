// The launch files of cameras, with stand-ins for the launch files of their drivers: these have the
// arguments and parameters that docs/cameras.md relies on.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "launch/launched.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

const std::string kMount = " mount:='1 2 3 0.4 0.5 0.6'";

class CamerasLaunchTest : public ::testing::Test {
 protected:
  /// A package NAME with a launch file.
  void addDriver(const std::string& name,
                 const std::string& file,
                 const std::string& launch) const {
    const std::string package = directory_ / name;
    std::filesystem::create_directories(package + "/launch");
    std::ofstream(package + "/package.xml")
        << "<package format=\"2\"><name>" << name
        << "</name><version>1.0.0</version><description/><maintainer email=\"a@b.invalid\">a"
           "</maintainer><license>BSD</license></package>";
    std::ofstream(package + "/launch/" + file) << "<launch>" << launch << "</launch>";
  }

  static std::string arguments(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += "<arg name=\"" + name + "\" default=\"\"/>";
    return text;
  }

  Launched launch(const std::string& file, const std::string& options) const {
    return Launched(
        "cameras/" + file, options, "ROS_PACKAGE_PATH=" + directory_ / "" + ":$ROS_PACKAGE_PATH");
  }

  TemporaryDirectory directory_;
};

TEST_F(CamerasLaunchTest, WithoutADriverInstalledTheOdometryStarts) {
  for (const std::string name : {"realsense", "usb_pair", "zed"}) {
    const Launched launched("cameras/" + name + ".launch", "driver:=false");
    EXPECT_TRUE(launched.hasNode("/" +
                                 (name == "realsense"  ? std::string("camera")
                                  : name == "usb_pair" ? "stereo"
                                                       : "zed2") +
                                 "/stereo_odometry"))
        << name;
  }
}

TEST_F(CamerasLaunchTest, Realsense) {
  addDriver("realsense2_camera",
            "rs_camera.launch",
            arguments({"camera",
                       "enable_infra1",
                       "enable_infra2",
                       "enable_color",
                       "enable_depth",
                       "infra_width",
                       "infra_height",
                       "infra_fps"}) +
                "<param name=\"infra1\" value=\"$(arg enable_infra1)\"/>");
  const Launched launched = launch("realsense.launch", "camera:=front" + kMount);
  EXPECT_TRUE(launched.param<bool>("/infra1"));
  EXPECT_EQ(launched.param<int>("/front/stereo_module/emitter_enabled"), 0);
  const std::string odometry = "/front/stereo_odometry";
  EXPECT_EQ(launched.topic(odometry, "left/image_rect"), "infra1/image_rect_raw");
  EXPECT_EQ(launched.topic(odometry, "right/image_rect"), "infra2/image_rect_raw");
  EXPECT_EQ(launched.topic(odometry, "left/camera_info"), "infra1/camera_info");
  EXPECT_EQ(launched.topic(odometry, "right/camera_info"), "infra2/camera_info");
  EXPECT_EQ(launched.property("/front_link_mount", "args"),
            "1 2 3 0.4 0.5 0.6 base_link front_link");
  EXPECT_FALSE(launch("realsense.launch", "").hasNode("/camera_link_mount"));
}

TEST_F(CamerasLaunchTest, Zed) {
  const std::string pose =
      "$(arg cam_pos_x) $(arg cam_pos_y) $(arg cam_pos_z) $(arg cam_yaw) "
      "$(arg cam_pitch) $(arg cam_roll)";
  addDriver("zed_wrapper",
            "zed2i.launch",
            arguments({"camera_name",
                       "base_frame",
                       "publish_urdf",
                       "cam_pos_x",
                       "cam_pos_y",
                       "cam_pos_z",
                       "cam_roll",
                       "cam_pitch",
                       "cam_yaw"}) +
                "<param name=\"/pose\" value=\"" + pose +
                "\"/><param name=\"/urdf\" value=\"$(arg publish_urdf)\"/>"
                "<param name=\"/base\" value=\"$(arg base_frame)\"/>"
                "<group ns=\"$(arg camera_name)/zed_node/pos_tracking\">"
                "<param name=\"publish_tf\" value=\"true\"/>"
                "<param name=\"publish_map_tf\" value=\"true\"/></group>");
  const Launched launched =
      launch("zed.launch", "model:=zed2i camera:=eyes base_frame:=body" + kMount);
  EXPECT_EQ(launched.param("/pose"), "1 2 3 0.4 0.5 0.6");
  EXPECT_EQ(launched.param("/base"), "body");
  EXPECT_TRUE(launched.param<bool>("/urdf"));
  EXPECT_FALSE(launched.param<bool>("/eyes/zed_node/pos_tracking/publish_tf"));
  EXPECT_FALSE(launched.param<bool>("/eyes/zed_node/pos_tracking/publish_map_tf"));
  const std::string odometry = "/eyes/stereo_odometry";
  EXPECT_EQ(launched.topic(odometry, "left/image_rect"), "zed_node/left/image_rect_gray");
  EXPECT_EQ(launched.topic(odometry, "right/image_rect"), "zed_node/right/image_rect_gray");
  EXPECT_EQ(launched.topic(odometry, "left/camera_info"), "zed_node/left/camera_info");
  EXPECT_EQ(launched.topic(odometry, "right/camera_info"), "zed_node/right/camera_info");
  EXPECT_EQ(launched.param(odometry + "/base_frame"), "body");
  EXPECT_FALSE(launch("zed.launch", "model:=zed2i").param<bool>("/urdf"));
}

TEST_F(CamerasLaunchTest, UsbPair) {
  const Launched launched =
      launch("usb_pair.launch", "right_device:=/dev/video4 framerate:=25" + kMount);
  EXPECT_EQ(launched.property("/stereo/left", "type"), "usb_cam/usb_cam_node");
  EXPECT_EQ(launched.param("/stereo/left/video_device"), "/dev/video0");
  EXPECT_EQ(launched.param("/stereo/right/video_device"), "/dev/video4");
  EXPECT_EQ(launched.param("/stereo/right/camera_frame_id"), "stereo_right_optical");
  EXPECT_EQ(launched.param<int>("/stereo/right/framerate"), 25);
  EXPECT_TRUE(launched.param<bool>("/stereo/stereo_odometry/rectify"));
  EXPECT_EQ(launched.param<double>("/stereo/stereo_odometry/max_stamp_difference_s"), 0.02);
  EXPECT_EQ(launched.property("/stereo_link_mount", "args"),
            "1 2 3 0.4 0.5 0.6 base_link stereo_link");
  EXPECT_EQ(launched.property("/stereo_left_optical_tf", "args"),
            "0 0 0 -1.570796 0 -1.570796 stereo_link stereo_left_optical");
}

TEST_F(CamerasLaunchTest, Euroc) {
  const Launched launched = launch("euroc.launch", "bag:=/data/MH_01.bag rviz:=false");
  const std::string play = launched.property("/player", "args");
  EXPECT_NE(play.find("--clock"), std::string::npos) << play;
  EXPECT_NE(play.find("/data/MH_01.bag"), std::string::npos) << play;
  EXPECT_TRUE(launched.param<bool>("/use_sim_time"));
  EXPECT_TRUE(launched.hasNode("/reset_sim_time"));
  EXPECT_EQ(launched.topic("/player", "/cam0/image_raw"), "stereo/left/image_raw");
  EXPECT_EQ(launched.topic("/player", "/cam1/image_raw"), "stereo/right/image_raw");
  EXPECT_EQ(launched.topic("/stereo/right_info", "image"), "right/image_raw");
  EXPECT_EQ(launched.topic("/stereo/right_info", "camera_info"), "right/camera_info");
  const std::string odometry = "/stereo/stereo_odometry";
  EXPECT_TRUE(launched.param<bool>(odometry + "/rectify"));
  EXPECT_EQ(launched.param(odometry + "/camera_frame"), "cam0");
}

cv::Matx33d rectification(const YAML::Node& camera) {
  return cv::Matx33d(camera["rectification_matrix"]["data"].as<std::vector<double>>().data());
}
cv::Matx34d projection(const YAML::Node& camera) {
  return cv::Matx34d(camera["projection_matrix"]["data"].as<std::vector<double>>().data());
}

/// T_BS of sensor.yaml of the dataset.
const cv::Matx44d kBodyLeft(0.0148655429818,
                            -0.999880929698,
                            0.00414029679422,
                            -0.0216401454975,
                            0.999557249008,
                            0.0149672133247,
                            0.025715529948,
                            -0.064676986768,
                            -0.0257744366974,
                            0.00375618835797,
                            0.999660727178,
                            0.00981073058949,
                            0.0,
                            0.0,
                            0.0,
                            1.0);
const cv::Matx44d kBodyRight(0.0125552670891,
                             -0.999755099723,
                             0.0182237714554,
                             -0.0198435579556,
                             0.999598781151,
                             0.0130119051815,
                             0.0251588363115,
                             0.0453689425024,
                             -0.0253898008918,
                             0.0179005838253,
                             0.999517347078,
                             0.00786212447038,
                             0.0,
                             0.0,
                             0.0,
                             1.0);
constexpr double kDigits = 1e-9;  // of T_BS

TEST(EurocCalibrationTest, RectifiesTheCamerasAsAPair) {
  const YAML::Node left = YAML::LoadFile(CONFIG_DIR "/cameras/euroc_left.yaml");
  const YAML::Node right = YAML::LoadFile(CONFIG_DIR "/cameras/euroc_right.yaml");
  const cv::Matx44d right_left = kBodyRight.inv() * kBodyLeft;
  const cv::Matx33d turn = right_left.get_minor<3, 3>(0, 0);
  EXPECT_LT(cv::norm(rectification(right) * turn - rectification(left)), kDigits);
  const cv::Matx31d baseline = rectification(right) * right_left.get_minor<3, 1>(0, 3);
  EXPECT_LT(std::hypot(baseline(1), baseline(2)), kDigits);
  const cv::Matx34d P = projection(right);
  EXPECT_NEAR(P(0, 3) / P(0, 0), baseline(0), kDigits);
  EXPECT_LT(cv::norm(P.get_minor<3, 3>(0, 0) - projection(left).get_minor<3, 3>(0, 0)), kDigits);
}

/// The transform of static_transform_publisher.
cv::Matx44d toTransform(const std::string& args) {
  std::istringstream stream(args);
  double x, y, z, yaw, pitch, roll;
  stream >> x >> y >> z >> yaw >> pitch >> roll;
  const cv::Matx33d turn =
      cv::Matx33d(std::cos(yaw), -std::sin(yaw), 0, std::sin(yaw), std::cos(yaw), 0, 0, 0, 1) *
      cv::Matx33d(
          std::cos(pitch), 0, std::sin(pitch), 0, 1, 0, -std::sin(pitch), 0, std::cos(pitch)) *
      cv::Matx33d(1, 0, 0, 0, std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll));
  return cv::Matx44d(turn(0, 0),
                     turn(0, 1),
                     turn(0, 2),
                     x,
                     turn(1, 0),
                     turn(1, 1),
                     turn(1, 2),
                     y,
                     turn(2, 0),
                     turn(2, 1),
                     turn(2, 2),
                     z,
                     0,
                     0,
                     0,
                     1);
}

TEST_F(CamerasLaunchTest, EurocBaseHasTheAxesOfARobot) {
  const Launched launched = launch("euroc.launch", "bag:=any.bag rviz:=false");
  // The body has x up, y right and z forward.
  const cv::Matx44d T_base_body(0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1);
  const double digits = 2e-6;  // of the launch file
  EXPECT_LT(
      cv::norm(toTransform(launched.property("/cam0_mount", "args")) - T_base_body * kBodyLeft),
      digits);
}

}  // namespace
}  // namespace rotrocc
