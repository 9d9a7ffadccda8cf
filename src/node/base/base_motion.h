#pragma once

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// Motion of the base on which a camera is mounted, where `camera_motion` is T_prev_cur of the
/// camera: T_base_camera_prev * T_prev_cur * T_base_camera_cur^-1. The mounts have no errors.
UncertainTransform motionOfBase(const UncertainTransform& camera_motion,
                                const Eigen::Isometry3d& T_base_camera_prev,
                                const Eigen::Isometry3d& T_base_camera_cur);

/// Velocities [m/s, rad/s] of a body in its own frame, with covariance.
struct UncertainTwist {
  Vector6d twist = Vector6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();
};

/// The constant twist of the motion T_prev_cur in `dt_s` > 0. The covariance is valid for small
/// rotations within that time.
UncertainTwist twistOf(const UncertainTransform& T_prev_cur, double dt_s);

/// Translation and rotation of the motion T_prev_cur over `dt_s` > 0, in the frame before it.
UncertainTwist meanVelocityOf(const UncertainTransform& T_prev_cur, double dt_s);

}  // namespace rotrocc
