#pragma once

#include <Eigen/Geometry>

namespace rotrocc {

/// Accumulates camera motions to the pose of the camera in its first frame. The result is
/// deterministic to the bit, and the rotation stays orthonormal for any number of motions.
class PoseAccumulator {
 public:
  /// Appends the motion to the current frame: `T_prev_cur` maps points of the current frame to the
  /// previous frame. Returns T_first_cur.
  const Eigen::Isometry3d& add(const Eigen::Isometry3d& T_prev_cur) {
    T_first_cur_ = T_first_cur_ * T_prev_cur;
    const Eigen::Quaterniond rotation(T_first_cur_.linear());
    T_first_cur_.linear() = rotation.normalized().toRotationMatrix();
    return T_first_cur_;
  }

  const Eigen::Isometry3d& T_first_cur() const { return T_first_cur_; }

 private:
  Eigen::Isometry3d T_first_cur_ = Eigen::Isometry3d::Identity();
};

}  // namespace rotrocc
