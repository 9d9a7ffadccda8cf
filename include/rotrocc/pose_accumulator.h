#pragma once

#include <Eigen/Geometry>

namespace rotrocc {

/// The pose of a camera in the frame of its first one, out of its motions. The same motions give
/// the same bits, and the rotation stays one however many there are.
class PoseAccumulator {
 public:
  /// Appends the motion to the current frame: `T_prev_cur` maps its points to the previous frame.
  /// Returns T_first_cur.
  const Eigen::Isometry3d& add(const Eigen::Isometry3d& T_prev_cur);

  const Eigen::Isometry3d& T_first_cur() const { return T_first_cur_; }

 private:
  Eigen::Isometry3d T_first_cur_ = Eigen::Isometry3d::Identity();
};

}  // namespace rotrocc
