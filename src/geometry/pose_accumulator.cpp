#include "rotrocc/pose_accumulator.h"

namespace rotrocc {

const Eigen::Isometry3d& PoseAccumulator::add(const Eigen::Isometry3d& T_prev_cur) {
  T_first_cur_ = T_first_cur_ * T_prev_cur;
  const Eigen::Quaterniond rotation(T_first_cur_.linear());
  T_first_cur_.linear() = rotation.normalized().toRotationMatrix();
  return T_first_cur_;
}

}  // namespace rotrocc
