#pragma once

#include <Eigen/Geometry>

#include "rotrocc/odometry_config.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// Covariance of the systematic error of a motion, in the order of OdometryResult::covariance: the
/// same in all directions, in proportion to its length and its angle.
///
/// Errors of the lenses, the focal length, the baseline and the time stamps change all features
/// alike, so no scatter of their residuals shows them, and motions do not average them out.
inline Matrix6d systematicCovariance(const SystematicErrorConfig& config,
                                     const Eigen::Isometry3d& motion) {
  const double translation_m = config.translation_share * motion.translation().norm();
  const double rotation_rad = config.rotation_share * logRotation(motion.linear()).norm();
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(translation_m), Eigen::Vector3d::Constant(rotation_rad);
  return sigma.cwiseAbs2().asDiagonal();
}

}  // namespace rotrocc
