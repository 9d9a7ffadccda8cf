#pragma once

#include <string>

#include <nav_msgs/Path.h>
#include <Eigen/Geometry>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// Converts a recorded trajectory of a body to the path of the base it is mounted on, relative to
/// the first pose of the base, where the odometry starts.
nav_msgs::Path groundTruthPath(const Trajectory& recorded,
                               const Eigen::Isometry3d& T_base_body,
                               const std::string& odom_frame);

/// Writes the path of a base as poses of its camera, relative to the first one, in TUM format, like
/// the trajectory that the odometry writes. Throws std::runtime_error if that fails.
void writeGroundTruth(const std::string& file,
                      const nav_msgs::Path& path_of_base,
                      const Eigen::Isometry3d& T_base_camera);

}  // namespace rotrocc
