#include "odometry/motion_model.h"

namespace rotrocc {

void MotionModel::update(const Eigen::Isometry3d& T_prev_cur, double dt_s) {
  twist_ = logMotion(T_prev_cur) / dt_s;
}

std::optional<Eigen::Isometry3d> MotionModel::predict(
    double dt_s, const std::optional<Eigen::Matrix3d>& measured_rotation) const {
  if (!twist_ || dt_s > max_age_s_) return std::nullopt;
  Vector6d motion = *twist_ * dt_s;
  if (measured_rotation) motion.tail<3>() = logRotation(*measured_rotation);
  return expMotion(motion);
}

}  // namespace rotrocc
