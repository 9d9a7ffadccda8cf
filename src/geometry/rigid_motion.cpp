#include "rotrocc/rigid_motion.h"

#include <cmath>

namespace rotrocc {

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

Eigen::Matrix3d expRotation(const Eigen::Vector3d& v) {
  return Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix();
}

Eigen::Vector3d logRotation(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd rotation{Eigen::Quaterniond(R)};
  return rotation.angle() * rotation.axis();
}

Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& v) {
  constexpr double kSmall_rad = 1e-4;  // the truncated series is exact to double precision
  const double angle = v.norm();
  const Eigen::Matrix3d K = skew(v);
  if (angle < kSmall_rad) return Eigen::Matrix3d::Identity() + K / 2.0 + K * K / 6.0;
  const double angle2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / angle2 * K +
         (angle - std::sin(angle)) / (angle2 * angle) * K * K;
}

Eigen::Isometry3d expMotion(const Vector6d& twist) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = expRotation(twist.tail<3>());
  T.translation() = leftJacobian(twist.tail<3>()) * twist.head<3>();
  return T;
}

Vector6d logMotion(const Eigen::Isometry3d& T) {
  Vector6d twist;
  twist.tail<3>() = logRotation(T.linear());
  twist.head<3>() = leftJacobian(twist.tail<3>()).partialPivLu().solve(T.translation());
  return twist;
}

}  // namespace rotrocc
