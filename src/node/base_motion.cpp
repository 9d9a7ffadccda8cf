#include "node/base_motion.h"

namespace rotrocc {

UncertainTransform motionOfBase(const UncertainTransform& camera_motion,
                                const Eigen::Isometry3d& T_base_camera) {
  const Eigen::Isometry3d T = T_base_camera * camera_motion.T * T_base_camera.inverse();
  const Eigen::Matrix3d R = T_base_camera.linear();
  // t_base = R t_camera + lever - R_base lever: a rotation error displaces the lever.
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = R;
  J.topRightCorner<3, 3>() = skew(T.linear() * T_base_camera.translation()) * R;
  J.bottomRightCorner<3, 3>() = R;
  return {T, J * camera_motion.covariance * J.transpose()};
}

UncertainTwist twistOf(const UncertainTransform& T_prev_cur, double dt_s) {
  return {logMotion(T_prev_cur.T) / dt_s, T_prev_cur.covariance / (dt_s * dt_s)};
}

}  // namespace rotrocc
