#include "odometry/systematic_error.h"

namespace rotrocc {

Matrix6d systematicCovariance(const SystematicErrorConfig& config,
                              const Eigen::Isometry3d& motion) {
  const double translation_m = config.translation_share * motion.translation().norm();
  const double rotation_rad = config.rotation_share * logRotation(motion.linear()).norm();
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(translation_m), Eigen::Vector3d::Constant(rotation_rad);
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace rotrocc
