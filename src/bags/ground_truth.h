#pragma once

#include <string>

#include <nav_msgs/Path.h>
#include <Eigen/Geometry>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// A recorded trajectory of a body as the path of the base it is mounted on, relative to the first
/// pose of the base and so comparable to the odometry, which begins there.
nav_msgs::Path groundTruthPath(const Trajectory& recorded,
                               const Eigen::Isometry3d& T_base_body,
                               const std::string& odom_frame);

/// Writes the path of a base as poses of the camera on it, relative to the first one, in TUM
/// format: to be compared with the trajectory that the odometry writes. Throws std::runtime_error
/// if it cannot.
void writeGroundTruth(const std::string& file,
                      const nav_msgs::Path& path_of_base,
                      const Eigen::Isometry3d& T_base_camera);

}  // namespace rotrocc
