#pragma once

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// The motion of the base that a camera is fixed to, where `camera_motion` is T_prev_cur of the
/// camera: T_base_camera * T_prev_cur * T_base_camera^-1.
UncertainTransform motionOfBase(const UncertainTransform& camera_motion,
                                const Eigen::Isometry3d& T_base_camera);

/// The velocities [m/s, rad/s] of a body in its own axes, and their covariance.
struct UncertainTwist {
  Vector6d twist = Vector6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();
};

/// The constant twist that makes the motion T_prev_cur in `dt_s` > 0. The covariance holds for
/// turns that are small within that time.
UncertainTwist twistOf(const UncertainTransform& T_prev_cur, double dt_s);

}  // namespace rotrocc
