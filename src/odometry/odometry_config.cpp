#include "rotrocc/odometry_config.h"

#include <stdexcept>

#include "motion/two_stage_estimator.h"

namespace rotrocc {

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"default", "paper"};
  return names;
}

Matrix6d SystematicErrorConfig::covarianceOf(const Eigen::Isometry3d& motion) const {
  // Axes turned by e see the translation t + e x t and the rotation Exp(e) R Exp(-e).
  Eigen::Matrix<double, 6, 3> by_axes;
  by_axes << -skew(motion.translation()), Eigen::Matrix3d::Identity() - motion.linear();
  Eigen::Matrix<double, 6, 2> by_scale = Eigen::Matrix<double, 6, 2>::Zero();
  by_scale.topLeftCorner<3, 1>() = motion.translation();
  by_scale.bottomRightCorner<3, 1>() = logRotation(motion.linear());
  return axes_rad * axes_rad * by_axes * by_axes.transpose() +
         scale_share * scale_share * by_scale * by_scale.transpose();
}

void OdometryConfig::check() const {
  criterionOf(motion_estimator.criterion);
  if (method != "default" && method != "paper") {
    throw std::invalid_argument("method is \"" + method + "\", but must be default or paper");
  }
}

}  // namespace rotrocc
