#pragma once

#include <string>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// Poses recorded in a bag, with increasing stamps:
///   FILE.bag:TOPIC           of nav_msgs/Odometry, nav_msgs/Path (the last one), or
///                            geometry_msgs/PoseStamped, PoseWithCovarianceStamped or
///                            TransformStamped
///   FILE.bag:PARENT:CHILD    of tf from a frame to one that is directly below it
///   FILE.bag                 of the only topic of nav_msgs/Odometry
/// Throws std::runtime_error with the topics if there are no such poses, or more than one topic.
Trajectory readRecordedTrajectory(const std::string& name);

/// Whether a name is one of these.
bool isInBag(const std::string& name);

}  // namespace rotrocc
