#include "rotrocc/odometry_config.h"

#include <stdexcept>

#include "motion/two_stage_estimator.h"

namespace rotrocc {

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"default", "paper"};
  return names;
}

Matrix6d SystematicErrorConfig::covarianceOf(const Eigen::Isometry3d& motion) const {
  const double translation_m = translation_share * motion.translation().norm();
  const double rotation_rad = rotation_share * logRotation(motion.linear()).norm();
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(translation_m), Eigen::Vector3d::Constant(rotation_rad);
  return sigma.cwiseAbs2().asDiagonal();
}

void OdometryConfig::check() const {
  criterionOf(motion_estimator.criterion);
  if (method != "default" && method != "paper") {
    throw std::invalid_argument("method is \"" + method + "\", but must be default or paper");
  }
}

}  // namespace rotrocc
