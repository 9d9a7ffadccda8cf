#include "node/base/base_motion.h"

namespace rotrocc {

UncertainTransform motionOfBase(const UncertainTransform& camera_motion,
                                const Eigen::Isometry3d& T_base_camera_prev,
                                const Eigen::Isometry3d& T_base_camera_cur) {
  const Eigen::Isometry3d T = T_base_camera_prev * camera_motion.T * T_base_camera_cur.inverse();
  const Eigen::Matrix3d R = T_base_camera_prev.linear();
  // t_base = R t_camera + lever_prev - R_base lever_cur: a rotation error displaces the lever.
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = R;
  J.topRightCorner<3, 3>() = skew(T.linear() * T_base_camera_cur.translation()) * R;
  J.bottomRightCorner<3, 3>() = R;
  return {T, J * camera_motion.covariance * J.transpose()};
}

UncertainTwist twistOf(const UncertainTransform& T_prev_cur, double dt_s) {
  return {logMotion(T_prev_cur.T) / dt_s, T_prev_cur.covariance / (dt_s * dt_s)};
}

UncertainTwist meanVelocityOf(const UncertainTransform& T_prev_cur, double dt_s) {
  UncertainTwist velocity;
  velocity.twist << T_prev_cur.T.translation(), logRotation(T_prev_cur.T.linear());
  velocity.twist /= dt_s;
  velocity.covariance = T_prev_cur.covariance / (dt_s * dt_s);
  return velocity;
}

}  // namespace rotrocc
