#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rotrocc {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The cross-product matrix: skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation by the angle |v| [rad] about the axis v, and its inverse. logRotation() returns an
/// angle of at most pi.
Eigen::Matrix3d expRotation(const Eigen::Vector3d& v);
Eigen::Vector3d logRotation(const Eigen::Matrix3d& R);

/// Left Jacobian J of SO(3). To first order,
/// expRotation(v + dv) = expRotation(J dv) * expRotation(v).
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& v);

/// The motion of a body with the constant twist [v; w] (m and rad, in the body's axes) during one
/// unit of time, and its inverse: the twist of a motion.
Eigen::Isometry3d expMotion(const Vector6d& twist);
Vector6d logMotion(const Eigen::Isometry3d& T);

}  // namespace rotrocc
