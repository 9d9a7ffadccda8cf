#pragma once

#include <string>

#include "rotrocc/trajectory.h"
#include "rotrocc/trajectory_error.h"

namespace rotrocc {

/// What evaluate_trajectory compares. Those that are not given are empty.
struct TrajectoryFiles {
  std::string truth;       ///< KITTI or TUM format, or a sequence with true poses
  std::string estimate;    ///< KITTI or TUM format
  std::string times;       ///< the stamps of poses in KITTI format
  std::string statistics;  ///< of offline_odometry from the same run as the estimate
};

/// Poses without stamps get those of the times, or else those of the statistics, if they are given,
/// or else 10 Hz. Throws std::runtime_error if they do not fit the poses, if the statistics have no
/// pair at a pose, and as readTrajectory().
Trajectory readEstimate(const TrajectoryFiles& files);

/// Pairs of poses: by line if both files have no stamps, else by stamp, up to 10 ms apart. Throws
/// std::runtime_error if only one of the files has stamps, if fewer than two poses match, and as
/// readEstimate().
MatchedTrajectories readMatched(const TrajectoryFiles& files);

}  // namespace rotrocc
