// What the launch files start and set for the arguments that users give, without starting anything.
// The drivers of cameras are stand-ins, with the arguments and parameters that docs/cameras.md
// relies on.

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "support/run_command.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// What read_launch.py prints.
using Launched = std::map<std::string, std::string>;

class LaunchFilesTest : public ::testing::Test {
 protected:
  /// Throws std::runtime_error if roslaunch rejects the file. `options` in the syntax of the shell.
  Launched launch(const std::string& file, const std::string& options = "") const {
    const std::string environment = "ROS_PACKAGE_PATH=" + directory_ / "" + ":$ROS_PACKAGE_PATH ";
    const CommandResult result =
        runCommand(environment + PYTHON " " ROOT "/test/launch/read_launch.py " ROOT "/launch/" +
                   file + " " + options);
    const auto json = result.output.find("{\"");
    if (result.status != 0 || json == std::string::npos) throw std::runtime_error(result.output);
    return YAML::Load(result.output.substr(json)).as<Launched>();
  }

  /// Expects these entries; "" for none.
  void expect(const std::string& file, const std::string& options, const Launched& entries) const {
    Launched launched = launch(file, options);
    for (const auto& [name, value] : entries) {
      EXPECT_EQ(launched[name], value) << name << " of " << file << " " << options;
    }
  }

  /// A package, whose launch file has `arguments` and sets them as parameters /driver/ARGUMENT.
  void addDriver(const std::string& package,
                 const std::string& file,
                 const std::string& arguments,
                 const std::string& further = "") const {
    std::filesystem::create_directories(directory_ / package + "/launch");
    directory_.write(package + "/package.xml",
                     "<package format=\"2\"><name>" + package +
                         "</name><version>1.0.0</version><description/><maintainer "
                         "email=\"a@b.invalid\">a</maintainer><license>BSD</license></package>");
    std::ofstream launch(directory_ / package + "/launch/" + file);
    launch << "<launch>" << further;
    std::istringstream names(arguments);
    for (std::string name; names >> name;) {
      launch << "<arg name=\"" << name << "\" default=\"\"/><param name=\"/driver/" << name
             << "\" value=\"$(arg " << name << ")\"/>";
    }
    launch << "</launch>";
  }

  TemporaryDirectory directory_;
};

/// Of a file for the argument config.
const Launched kParameters = {{"base_frame", "body"},
                              {"guess_frame", "wheels"},
                              {"image_transport", "compressed"},
                              {"max_stamp_difference_s", "0.02"},
                              {"odom_frame", "world"},
                              {"path_rate_hz", "5"},
                              {"planar", "true"},
                              {"publish_tf", "false"},
                              {"rectify", "true"},
                              {"trajectory_file", "/of_config"},
                              {"trajectory_format", "kitti"}};
const std::string kNode = "/camera/stereo_odometry";
const std::string kPose = " camera_pose:='1 2 3 0.4 0.5 0.6'";
const std::string kPublisher = "tf2_ros/static_transform_publisher ";

/// stereo_odometry.launch and replay.launch with that file; kitti.launch is the latter.
class ConfiguredLaunchTest : public LaunchFilesTest {
 protected:
  ConfiguredLaunchTest() {
    std::ofstream file(directory_ / "robot.yaml");
    for (const auto& [name, value] : kParameters) file << name << ": " << value << "\n";
  }

  void expectCamera(const std::string& options, const Launched& entries) const {
    expect("stereo_odometry.launch", "stereo:=/camera " + config_ + options, entries);
  }

  const std::string config_ = "config:=" + directory_ / "robot.yaml";
};

TEST_F(ConfiguredLaunchTest, TheFileHolds) {
  Launched entries = {{kNode + "/use_imu", ""},
                      {"cleared", kNode + "/"},
                      {"warnings", "0"},
                      {kNode + " odom", "odom"}};
  Launched of_kitti = {{"/stereo/kitti_player/base_frame", "body"},
                       {"/stereo/kitti_player/lockstep_timeout_s", "10.0"},
                       {"/stereo/kitti_player/max_stamp_difference_s", "0.02"},
                       {"/stereo/kitti_player/rectify", "true"},
                       {"cleared", "/stereo/stereo_odometry/ /stereo/kitti_player/"},
                       {"warnings", "0"}};
  for (const auto& [name, value] : kParameters) {
    entries[kNode + "/" + name] = value;
    of_kitti["/stereo/stereo_odometry/" + name] = value;
  }
  expectCamera("", entries);
  expect("kitti.launch", "bag:=any.bag rviz:=false " + config_, of_kitti);
}

TEST_F(ConfiguredLaunchTest, ArgumentsOverrideIt) {
  expectCamera(" odom_frame:=odom base_frame:=base_link publish_tf:=true rectify:=false",
               {{kNode + "/odom_frame", "odom"},
                {kNode + "/base_frame", "base_link"},
                {kNode + "/publish_tf", "true"},
                {kNode + "/rectify", "false"},
                {"warnings", "0"}});
  expect("replay.launch",
         "bag:=any.bag rectify:=true base_frame:=body lockstep_timeout:=0 trajectory_file:=/new "
         "calibration:=/camchain.yaml",
         {{"/stereo/rviz", "rotrocc/rig_view " ROOT "/rviz/kitti.rviz"},
          {"/stereo/stereo_odometry/base_frame", "body"},
          {"/stereo/kitti_player/base_frame", "body"},
          {"/stereo/stereo_odometry/rectify", "true"},
          {"/stereo/stereo_odometry/trajectory_file", "/new"},
          {"/stereo/kitti_player/rectify", "true"},
          {"/stereo/kitti_player/calibration", "/camchain.yaml"},
          {"/stereo/kitti_player/lockstep_timeout_s", "0.0"},
          {"warnings", "0"}});
}

TEST_F(ConfiguredLaunchTest, TopicsAreWhereTheUserWants) {
  Launched entries;
  for (const std::string topic : {"odom", "twist", "path", "status", "inliers", "flow"}) {
    entries[kNode + " " + topic] = "/vo/" + topic;
  }
  expectCamera(" output_ns:=/vo", entries);
  expectCamera(" output_ns:=vo odom_topic:=/odometry/visual rviz:=true",
               {{kNode + " odom", "/odometry/visual"},
                {kNode + " path", "vo/path"},
                {"/camera/rviz odom", "/odometry/visual"},
                {"/camera/rviz", "rotrocc/rig_view " ROOT "/rviz/stereo_odometry.rviz"}});
  expectCamera(" left_image:=cam0/image right_image:=/cam1/image gyroscope:=/imu/data",
               {{kNode + " left/image_rect", "cam0/image"},
                {kNode + " left/image_raw", "cam0/image"},
                {kNode + " right/image_rect", "/cam1/image"},
                {kNode + " right/image_raw", "/cam1/image"},
                {kNode + " imu", "/imu/data"},
                {kNode + "/use_imu", "true"}});
}

TEST_F(ConfiguredLaunchTest, TheCameraIsWhereTheUserSays) {
  expectCamera(kPose + " base_frame:=body camera_link:=eyes",
               {{"/camera/camera_pose", kPublisher + "1 2 3 0.6 0.5 0.4 body eyes"}});
  expectCamera("", {{"/camera/camera_pose", ""}});
}

TEST_F(ConfiguredLaunchTest, NodesStartAgainOnRequest) {
  expectCamera("", {{"respawned", ""}});
  expectCamera(" respawn:=true", {{"respawned", "/camera/stereo_manager /camera/stereo_odometry"}});
}

TEST_F(ConfiguredLaunchTest, TheFilterBroadcastsTf) {
  addDriver("robot_localization", "any.launch", "");
  expect("ekf.launch",
         "planar:=true imu:=/imu/data gyroscope:=/gyro left_image:=/cam0 base_frame:=body "
         "odom_frame:=world respawn:=true",
         {{"/stereo/stereo_odometry/planar", "true"},
          {"/stereo/stereo_odometry/publish_tf", "false"},
          {"/stereo/stereo_odometry/base_frame", "body"},
          {"/stereo/stereo_odometry imu", "/gyro"},
          {"/stereo/stereo_odometry left/image_rect", "/cam0"},
          {"/ekf/two_d_mode", "true"},
          {"/ekf/base_link_frame", "body"},
          {"/ekf/odom_frame", "world"},
          {"/ekf/world_frame", "world"},
          {"/ekf/imu0", "/imu/data"},
          {"respawned", "/stereo/stereo_manager /stereo/stereo_odometry /ekf"},
          {"warnings", "0"}});
  Launched entries = {{"/stereo/stereo_odometry/base_frame", "body"},
                      {"/stereo/stereo_odometry/odom_frame", "world"},
                      {"/stereo/stereo_odometry imu", ""},
                      {"/ekf/base_link_frame", "body"},
                      {"/ekf/odom_frame", "world"}};
  expect("ekf.launch", config_, entries);
  entries["/ekf/odom_frame"] = "filtered";
  expect("ekf.launch",
         config_ + " filter_config:=" + directory_.write("filter.yaml", "odom_frame: filtered"),
         entries);
  const std::string quoted = "{odom_frame: 'world',\n base_frame:   \"body\"}  # of the robot\n";
  expect("ekf.launch",
         "config:='" + directory_.write("a file.yaml", quoted) + "'",
         {{"/ekf/base_link_frame", "body"}, {"/ekf/odom_frame", "world"}});
  expect("ekf.launch", "", {{"/ekf/base_link_frame", "base_link"}, {"/ekf/odom_frame", "odom"}});
}

TEST_F(LaunchFilesTest, CamerasTakeTheArgumentsOfTheOdometry) {
  const std::map<std::string, std::string> namespaces = {
      {"realsense", "/camera"}, {"usb_pair", "/stereo"}, {"zed", "/zed2"}};
  for (const auto& [file, ns] : namespaces) {
    const std::string odometry = ns + "/stereo_odometry";
    expect("cameras/" + file + ".launch",
           "driver:=false manager:=/theirs respawn:=true gyroscope:=/imu output_ns:=/vo "
           "odom_topic:=visual odom_frame:=world base_frame:=body publish_tf:=false",
           {{odometry, "nodelet/nodelet load rotrocc/StereoOdometry /theirs"},
            {odometry + " imu", "/imu"},
            {odometry + " odom", "/vo/visual"},
            {odometry + "/odom_frame", "world"},
            {odometry + "/base_frame", "body"},
            {odometry + "/publish_tf", "false"},
            {"respawned", odometry},
            {"warnings", "0"}});
  }
}

TEST_F(LaunchFilesTest, Realsense) {
  addDriver("realsense2_camera",
            "rs_camera.launch",
            "camera respawn enable_infra1 enable_infra2 enable_color enable_depth enable_gyro "
            "infra_width infra_height infra_fps");
  const std::string odometry = "/front/stereo_odometry";
  expect("cameras/realsense.launch",
         "camera:=front" + kPose,
         {{odometry, "nodelet/nodelet load rotrocc/StereoOdometry realsense2_camera_manager"},
          {"/driver/enable_infra1", "true"},
          {"/driver/enable_gyro", "false"},
          {"/front/stereo_module/emitter_enabled", "0"},
          {odometry + " left/image_rect", "infra1/image_rect_raw"},
          {odometry + " right/image_rect", "infra2/image_rect_raw"},
          {odometry + " left/camera_info", "infra1/camera_info"},
          {odometry + " right/camera_info", "infra2/camera_info"},
          {"/front/camera_pose", kPublisher + "1 2 3 0.6 0.5 0.4 base_link front_link"},
          {"warnings", "0"}});
  expect("cameras/realsense.launch",
         "gyroscope:=gyro/sample",
         {{"/camera/camera_pose", ""}, {"/driver/enable_gyro", "true"}});
}

TEST_F(LaunchFilesTest, Zed) {
  addDriver("zed_wrapper",
            "zed2i.launch",
            "camera_name base_frame publish_urdf cam_pos_x cam_pos_y cam_pos_z cam_roll cam_pitch "
            "cam_yaw",
            "<group ns=\"$(arg camera_name)/zed_node/pos_tracking\">"
            "<param name=\"publish_tf\" value=\"true\"/>"
            "<param name=\"publish_map_tf\" value=\"true\"/></group>");
  const std::string odometry = "/eyes/stereo_odometry";
  expect("cameras/zed.launch",
         "model:=zed2i camera:=eyes base_frame:=body" + kPose,
         {{odometry, "nodelet/nodelet load rotrocc/StereoOdometry zed_node"},
          {"/eyes/camera_pose", ""},
          {"/driver/cam_pos_z", "3"},
          {"/driver/cam_roll", "0.4"},
          {"/driver/cam_pitch", "0.5"},
          {"/driver/cam_yaw", "0.6"},
          {"/driver/base_frame", "body"},
          {"/driver/publish_urdf", "true"},
          {"/eyes/zed_node/pos_tracking/publish_tf", "false"},
          {"/eyes/zed_node/pos_tracking/publish_map_tf", "false"},
          {odometry + " left/image_rect", "zed_node/left/image_rect_gray"},
          {odometry + " right/image_rect", "zed_node/right/image_rect_gray"},
          {odometry + " left/camera_info", "zed_node/left/camera_info"},
          {odometry + " right/camera_info", "zed_node/right/camera_info"},
          {odometry + "/base_frame", "body"},
          {"warnings", "0"}});
  expect("cameras/zed.launch", "model:=zed2i", {{"/driver/publish_urdf", "false"}});
}

TEST_F(LaunchFilesTest, UsbPair) {
  expect("cameras/usb_pair.launch",
         "right_device:=/dev/video4 framerate:=25" + kPose,
         {{"/stereo/left", "usb_cam/usb_cam_node "},
          {"/stereo/left/video_device", "/dev/video0"},
          {"/stereo/right/video_device", "/dev/video4"},
          {"/stereo/right/camera_name", "stereo_right"},
          {"/stereo/right/camera_frame_id", "stereo_right_optical"},
          {"/stereo/right/image_width", "640"},
          {"/stereo/right/framerate", "25"},
          {"/stereo/right/pixel_format", "mjpeg"},
          {"/stereo/stereo_odometry/rectify", "true"},
          {"/stereo/stereo_odometry/max_stamp_difference_s", "0.02"},
          {"/stereo/camera_pose", kPublisher + "1 2 3 0.6 0.5 0.4 base_link stereo_link"},
          {"/stereo/left_optical",
           kPublisher + "0 0 0 -1.570796 0 -1.570796 stereo_link stereo_left_optical"},
          {"warnings", "0"}});
  expect("cameras/usb_pair.launch",
         "stereo:=/rig/rear",
         {{"/rig/rear/left/camera_name", "rig_rear_left"},
          {"/rig/rear/left/camera_frame_id", "rig_rear_left_optical"}});
}

TEST_F(LaunchFilesTest, Euroc) {
  expect("cameras/euroc.launch",
         "bag:=/MH_01.bag rviz:=false",
         {{"/player", "rosbag/play --clock --delay 3 --rate 1.0 --start 0.0 /MH_01.bag"},
          {"/use_sim_time", "true"},
          {"/reset_sim_time", "rotrocc/reset_sim_time player"},
          {"/player /cam0/image_raw", "stereo/left/image_raw"},
          {"/player /cam1/image_raw", "stereo/right/image_raw"},
          {"/stereo/right_info image", "right/image_raw"},
          {"/stereo/right_info camera_info", "right/camera_info"},
          {"/stereo/stereo_odometry/rectify", "true"},
          {"/stereo/stereo_odometry/camera_frame", "cam0"},
          {"warnings", "0"}});
}

TEST_F(LaunchFilesTest, TheBaseOfEurocHasTheAxesOfARobot) {
  std::istringstream mount(
      launch("cameras/euroc.launch", "bag:=any.bag rviz:=false")["/cam0_mount"]);
  std::string program;
  double x, y, z, yaw, pitch, roll;
  mount >> program >> x >> y >> z >> yaw >> pitch >> roll;
  const Eigen::Affine3d camera = Eigen::Translation3d(x, y, z) *
                                 Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  // T_BS of sensor.yaml of the data set, whose body has x up, y right and z forward.
  Eigen::Matrix4d base_camera;
  base_camera << -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,  //
      -0.999557249008, -0.0149672133247, -0.025715529948, 0.064676986768,               //
      0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,             //
      0, 0, 0, 1;
  constexpr double kDigits = 2e-6;  // of the launch file
  EXPECT_LT((camera.matrix() - base_camera).norm(), kDigits);
}

}  // namespace
}  // namespace rotrocc
