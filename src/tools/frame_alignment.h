#pragma once

#include <string>

#include <Eigen/Geometry>

#include "rotrocc/trajectory_error.h"

namespace rotrocc {

/// Where the body of the true poses is on the body of the estimated ones, e.g. base_link on a
/// camera, if both are rigidly connected.
struct FrameAlignment {
  Eigen::Isometry3d T_estimate_truth = Eigen::Isometry3d::Identity();
  double error_before = 0.0;  ///< mean difference of the motions of both, as a share of their way
  double error_after = 0.0;   ///< that which is left with T_estimate_truth

  /// Whether the frames differ significantly: the error is less than half, and was more than that
  /// of an odometry.
  bool isNeeded() const;

  /// "turned by 90.0 deg and 1.02 m away (0.00 0.10 1.01 m)"
  std::string describe() const;
};

/// Finds it from the motions over a twentieth of the path: hand-eye calibration. What they do not
/// show, as the height of a camera on a car, is zero. At least two poses are needed.
FrameAlignment alignFrames(const MatchedTrajectories& matched);

/// The poses of the body of the true poses by the estimate.
Trajectory withFrame(const Trajectory& estimate, const FrameAlignment& alignment);

}  // namespace rotrocc
