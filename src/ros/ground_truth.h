#pragma once

#include <string>

#include <Eigen/Geometry>
#include <nav_msgs/Path.h>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// A recorded trajectory of a body as the path of the base it is mounted on, relative to the first pose
/// of the base and so comparable to the odometry, which begins there.
nav_msgs::Path groundTruthPath(const Trajectory& recorded,
                               const Eigen::Isometry3d& T_base_body,
                               const std::string& odom_frame);

}  // namespace rotrocc
