#include "odometry/motion_model.h"

namespace rotrocc {

void MotionModel::update(const Eigen::Isometry3d& T_prev_cur, double dt_s) {
  twist_ = logMotion(T_prev_cur) / dt_s;
}

std::optional<Eigen::Isometry3d> MotionModel::predict(double dt_s) const {
  if (!twist_ || dt_s > config_.max_age_s) return std::nullopt;
  return expMotion(*twist_ * dt_s);
}

}  // namespace rotrocc
