#pragma once

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// A transform T_a_b and the covariance of its error in the axes of frame a, in the order of REP
/// 103: translation [m] x y z, rotation [rad] about x y z. The true transform has the rotation
/// Exp(rotation error) R and the translation t + translation error, as in OdometryResult and
/// geometry_msgs/PoseWithCovariance.
struct UncertainTransform {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();
};

/// Returns T_a_c = T_a_b * T_b_c. Assumes independent errors.
UncertainTransform compose(const UncertainTransform& T_a_b, const UncertainTransform& T_b_c);

/// Returns T_b_a.
UncertainTransform inverse(const UncertainTransform& T_a_b);

}  // namespace rotrocc
