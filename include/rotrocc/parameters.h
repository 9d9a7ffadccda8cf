#pragma once

#include <string>

#include "rotrocc/odometry_config.h"
#include "rotrocc/parameter_table.h"

namespace rotrocc {

/// What the ROS side needs to know beside the estimator.
struct NodeParameters {
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  std::string camera_frame;       ///< of the left images; empty: their frame_id
  bool publish_tf = true;         ///< odom_frame -> base_frame
  bool invert_tf = false;         ///< base_frame -> odom_frame instead
  bool planar = false;            ///< the base moves in its x-y plane
  std::string guess_frame;        ///< of another odometry of base_frame in tf; empty: none
  double guess_timeout_s = 0.05;  ///< how long a pair waits for that
  std::string image_transport = "raw";
  double max_stamp_difference_s = 0.01;       ///< between the left and the right image of a pair
  int queue_size = 4;                         ///< images that wait for their partner, on each side
  int max_image_pixels = 20'000'000;          ///< of an image; more are refused
  double max_future_s = 10.0;                 ///< stamps further ahead of the clock are refused
  double baseline_m = 0.0;                    ///< 0: that of camera_info
  std::string pose_after_time_jump = "keep";  ///< or "zero": when stamps begin anew
  double silence_s = 5.0;                     ///< without a pair, until the log says why
  std::string flow_view = "motion";           ///< one of flowViewNames()
  int path_length = 10000;                    ///< poses that the path topic keeps; 0: no path
  double lost_speed_sigma_mps = 10.0;         ///< how fast the position gets uncertain while lost
  double lost_turn_rate_sigma_rps = 0.5;
  int trajectory_length = 100'000;        ///< poses kept for ~save_trajectory
  std::string trajectory_file;            ///< every pose is written there; empty: none
  std::string trajectory_format = "tum";  ///< or "kitti"
};

/// All parameters of the package.
struct Parameters {
  OdometryConfig odometry;
  NodeParameters node;
};

/// The table that names and guards every member of `parameters`, which must outlive it.
ParameterTable makeParameterTable(Parameters& parameters);

/// Sets what the YAML file at `path` names. Throws std::invalid_argument with the path on a file
/// that cannot be read, is no YAML, or names an unknown parameter or a value out of range.
void loadYaml(const std::string& path, ParameterTable& table);

/// The table as a YAML file, with unit, range and meaning of each parameter in a comment.
std::string toYaml(const ParameterTable& table);

}  // namespace rotrocc
