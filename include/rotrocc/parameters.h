#pragma once

#include <array>
#include <string>

#include "rotrocc/odometry_config.h"
#include "rotrocc/parameter_table.h"

namespace rotrocc {

/// Parameters of the ROS node, besides those of the estimator.
struct NodeParameters {
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  std::string camera_frame;                 ///< frame of the left images; empty: their frame_id
  bool publish_tf = true;                   ///< broadcast odom_frame -> base_frame
  bool invert_tf = false;                   ///< broadcast base_frame -> odom_frame instead
  bool planar = false;                      ///< restrict base_frame to motion in its x-y plane
  std::array<double, 6> initial_pose = {};  ///< x y z [m] roll pitch yaw [rad] at the first pair
  double transform_timeout_s = 0.2;  ///< longest wait of a pair for the tf of a moving camera
  std::string guess_frame;           ///< odom frame of another odometry in tf; empty: none
  std::string guess_topic;           ///< of another odometry without tf; empty: none
  bool use_imu = false;              ///< predict rotations with the gyroscope on topic imu
  bool rectify = false;              ///< take raw images, and rectify them with camera_info
  std::string image_transport = "raw";
  double max_stamp_difference_s = 0.01;  ///< between the left and the right image of a pair
  int queue_size = 4;                    ///< unmatched images kept, for each side
  int significant_bits = 0;              ///< of 16-bit images; 0: found from them
  std::string mask;         ///< PNG file, not black where images have no features; empty: none
  double baseline_m = 0.0;  ///< 0: that of camera_info
  std::string pose_after_time_jump = "keep";  ///< or "initial": when time jumps back
  double no_input_warning_s = 5.0;        ///< time without a pair before the log reports the reason
  double path_rate_hz = 2.0;              ///< at most, of the messages on the path topic
  std::string while_lost = "hold";        ///< or "silent" or "unknown": what is published then
  double reset_after_lost_s = 0.0;        ///< the estimator restarts after a longer loss; 0: never
  std::string pose_after_lost = "keep";   ///< or "initial": after that
  int trajectory_length = 100'000;        ///< number of poses kept for ~save_trajectory
  std::string trajectory_file;            ///< first of the files of all poses; empty: none
  std::string trajectory_format = "tum";  ///< or "kitti"
  std::string trajectory_frame = "camera";  ///< or "base": body of these poses
};

/// All parameters of the package.
struct Parameters {
  OdometryConfig odometry;
  NodeParameters node;
};

/// The table of all members of `parameters`, which must outlive it.
ParameterTable makeParameterTable(Parameters& parameters);

/// Sets the parameters that the YAML file at `path` contains. Throws std::invalid_argument with the
/// path if the file cannot be read, is not valid YAML, names an unknown parameter or has a value
/// out of range.
void loadYaml(const std::string& path, ParameterTable& table);

}  // namespace rotrocc
