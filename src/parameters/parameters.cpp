#include "rotrocc/parameters.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "files/read_yaml.h"

namespace rotrocc {
namespace {

void addNode(NodeParameters& n, ParameterTable& table) {
  table.add("odom_frame", n.odom_frame).description = "frame of the published pose";
  table.add("base_frame", n.base_frame).description =
      "robot frame whose pose and twist are published";
  table.add("camera_frame", n.camera_frame).description =
      "frame of the left camera; if empty, frame_id of the left images";
  table.add("publish_tf", n.publish_tf).description = "broadcast odom_frame -> base_frame";
  table.add("invert_tf", n.invert_tf).description = "broadcast base_frame -> odom_frame instead";
  table.add("planar", n.planar).description = "restrict the motion of base_frame to x, y and yaw";
  table.add("initial_pose", n.initial_pose, "m, rad").description =
      "x y z roll pitch yaw of base_frame in odom_frame at the first pair, also after a reset";
  table.add("transform_timeout_s", n.transform_timeout_s, {0.0, 10.0, "s"}).description =
      "longest wait of a pair for the transform of a moving camera mount; without a transform the "
      "pair is dropped";
  table.add("guess_frame", n.guess_frame).description =
      "odom frame of another odometry in tf, used as motion prediction; odom_frame -> guess_frame "
      "is then broadcast; none if empty";
  table.add("guess_topic", n.guess_topic).description =
      "nav_msgs/Odometry of another odometry that sends no tf, used in the same way; none if empty";
  table.add("use_imu", n.use_imu).description =
      "predict rotations with the gyroscope on the topic imu, whose frame must be in tf; while the "
      "robot is stationary, its accelerations level the first pose, unless initial_pose has roll "
      "or pitch";
  table.add("rectify", n.rectify).description =
      "subscribe to left/image_raw and right/image_raw instead of image_rect, and rectify by K, "
      "D, R and P of camera_info";
  table.add("image_transport", n.image_transport).description =
      "transport of both images: raw, compressed, ...";
  table.add("max_stamp_difference_s", n.max_stamp_difference_s, {0.0, 1.0, "s"}).description =
      "largest stamp difference between the left and the right image of a pair";
  table.add("queue_size", n.queue_size, {1, 100}).description = "unmatched images kept per side";
  auto& bits = table.add("significant_bits", n.significant_bits, {0, 16});
  bits.description =
      "bits used by 16-bit images, 8 or more, e.g. 10 or 12; 0: detect from the images";
  bits.set = [&value = n.significant_bits, set = bits.set](const std::string& text) {
    const int before = value;
    set(text);
    if (value == 0 || value >= 8) return;
    value = before;
    throw std::invalid_argument("is " + text + ", but must be 0 or in [8, 16]");
  };
  table.add("mask", n.mask).description =
      "image-sized PNG file, not black where features are not allowed, e.g. on the robot itself; "
      "%s in its name is replaced by left and right; none if empty";
  table.add("baseline_m", n.baseline_m, {0.0, 100.0, "m"}).description =
      "baseline, if camera_info has none in P[3]; 0: use P[3]";
  table.add("pose_after_time_jump", n.pose_after_time_jump, {"keep", "initial"}).description =
      "pose after time jumps back, e.g. with a looping bag; initial: initial_pose";
  table.add("no_input_warning_s", n.no_input_warning_s, {0.5, 3600.0, "s"}).description =
      "time without a stereo pair before the log reports the received input and a remedy";
  table.add("path_rate_hz", n.path_rate_hz, {0.01, 1000.0, "Hz"}).description =
      "maximum rate of the path topic, in real time";
  table.add("while_lost", n.while_lost, {"hold", "silent", "unknown"}).description =
      "output while tracking is lost: hold: the last pose with growing covariance; silent: neither "
      "tf nor odom; unknown: odom with a zero pose of variance 9999, no tf";
  table.add("reset_after_lost_s", n.reset_after_lost_s, {0.0, 1e6, "s"}).description =
      "restart the estimator with the next pair after being lost this long; 0: keep trying instead";
  table.add("pose_after_lost", n.pose_after_lost, {"keep", "initial"}).description =
      "pose after reset_after_lost_s; initial: initial_pose";
  table.add("trajectory_length", n.trajectory_length, {1, 10000000}).description =
      "number of poses kept for the service save_trajectory";
  table.add("trajectory_file", n.trajectory_file).description =
      "file for the poses of the left camera, none if empty; it is never replaced: a later "
      "trajectory goes to NAME_2, NAME_3, ...";
  table.add("trajectory_format", n.trajectory_format, {"tum", "kitti"}).description =
      "format of trajectory_file";
  table.add("trajectory_frame", n.trajectory_frame, {"camera", "base"}).description =
      "body whose poses trajectory_file and save_trajectory contain: the left camera or base_frame";
}

void addOdometry(OdometryConfig& c, ParameterTable& table) {
  CorrespondenceFinderConfig& finder = c.correspondence_finder;
  table.beginSection("feature_detector");
  table.add("max_features", finder.feature_detector.max_features, {50, 20000}).description =
      "maximum number of features: a corner without a disparity is replaced by the next one";
  table.add("wanted_inliers", finder.feature_detector.wanted_inliers, {50, 20000}).description =
      "number of features that should agree on the motion: the larger the fraction that agrees, "
      "the fewer are tracked; not with method: paper";
  table.add("min_halvings", finder.feature_detector.min_halvings, {0, 2}).description =
      "minimum number of times that images are halved, as long as the features have room: less "
      "time, larger errors; not with method: paper";

  StereoMatcherConfig& matcher = finder.stereo_matcher;
  table.beginSection("stereo_matcher");
  table.add("nearest_baselines", matcher.nearest_baselines, {0.1, 100.0}).description =
      "depth of the nearest matched points, as a multiple of the baseline";

  table.beginSection("feature_tracker");
  table.add("window_radius_px", finder.feature_tracker.window_radius_px, {2, 25, "px"})
      .description = "the Lucas-Kanade window is a square of side 2 radius + 1";

  table.beginSection("motion_estimator");
  table.add("criterion", c.motion_estimator.criterion, criterionNames()).description =
      "criterion that selects the inliers; others than rotrocc only with method: paper";

  MotionCheckConfig& check = c.motion_check;
  table.beginSection("motion_check");
  table.add("max_speed_mps", check.max_speed_mps, {0.1, 1000.0, "m/s"}).description =
      "speed above which the motion is lost";
  table.add("max_turn_rate_rps", check.max_turn_rate_rps, {0.1, 100.0, "rad/s"}).description =
      "turn rate above which the motion is lost";

  table.beginSection("stereo_calibrator");
  table.add("enabled", c.stereo_calibrator.enabled).description =
      "estimate and correct the disparity bias, the row offset and the delay of the right images";
  table.add("bias_px", c.stereo_calibrator.bias_px, {-20.0, 20.0, "px"}).description =
      "known correction, added to all disparities; initial value of the estimate";

  table.beginSection("systematic_error");
  table.add("scale_share", c.systematic_error.scale_share, {0.0, 1.0}).description =
      "relative standard deviation of the scale of motions, from baseline and focal length";
  table.add("axes_rad", c.systematic_error.axes_rad, {0.0, 1.0, "rad"}).description =
      "standard deviation of the camera's axes, from mount and rectification: they rotate each "
      "motion";
  table.add("common_share", c.systematic_error.common_share, {0.0, 1.0}).description =
      "fraction of the flow noise variance that all features share, from lenses and compression: "
      "it limits how well features average out";

  table.beginSection("visual_odometry");
  table.add("method", c.method, methodNames()).description =
      "paper: as published, together with the rest of config/paper.yaml";
  table.add("max_tries", c.max_tries, {1, 20}).description =
      "maximum number of attempts from each earlier frame: each tracks the features and estimates "
      "the motion";
}

/// Sets every scalar and list below `node`; `prefix` is the name of `node`.
void setAll(const YAML::Node& node, const std::string& prefix, ParameterTable& table) {
  if (node.IsScalar()) {
    // The parameter server and YAML take nothing else.
    if (YAML::Load(YAML::Dump(YAML::Node(node.Scalar()))).Scalar() != node.Scalar()) {
      throw std::invalid_argument("the value of parameter \"" + prefix + "\" is not UTF-8");
    }
    return table.set(prefix, node.Scalar());
  }
  if (node.IsSequence()) return table.setList(prefix, node.as<std::vector<std::string>>());
  if (!node.IsMap()) {
    throw std::invalid_argument("parameter \"" + prefix + "\" is neither a value nor a section");
  }
  // A recursive alias would never end.
  if (prefix.find('/') != std::string::npos) {
    throw std::invalid_argument("\"" + prefix + "\" must be a value: sections cannot be nested");
  }
  for (const auto& entry : node) {
    const auto name = entry.first.as<std::string>();
    setAll(entry.second, prefix.empty() ? name : prefix + "/" + name, table);
  }
}

}  // namespace

ParameterTable makeParameterTable(Parameters& parameters) {
  ParameterTable table;
  addNode(parameters.node, table);
  addOdometry(parameters.odometry, table);
  return table;
}

void loadYaml(const std::string& path, ParameterTable& table) {
  try {
    const YAML::Node root = readYaml(path);
    if (!root.IsNull()) setAll(root, "", table);
  } catch (const std::exception& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
}

}  // namespace rotrocc
