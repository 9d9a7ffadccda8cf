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
Matrix6d systematicCovariance(const SystematicErrorConfig& config, const Eigen::Isometry3d& motion);

}  // namespace rotrocc
