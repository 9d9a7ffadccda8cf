#include "uncertain_transform.h"

namespace rotrocc {
namespace {

/// The Jacobian of rotating both parts of an error by R, the rotation also shifting the
/// translation.
Matrix6d jacobian(const Eigen::Matrix3d& R, const Eigen::Matrix3d& translation_by_rotation) {
  Matrix6d J = Matrix6d::Zero();
  J.topLeftCorner<3, 3>() = R;
  J.topRightCorner<3, 3>() = translation_by_rotation;
  J.bottomRightCorner<3, 3>() = R;
  return J;
}

}  // namespace

UncertainTransform compose(const UncertainTransform& T_a_b, const UncertainTransform& T_b_c) {
  const Eigen::Matrix3d R = T_a_b.T.linear();
  // A rotation error of T_a_b swings the arm from b to c.
  const Matrix6d J_ab = jacobian(Eigen::Matrix3d::Identity(), -skew(R * T_b_c.T.translation()));
  const Matrix6d J_bc = jacobian(R, Eigen::Matrix3d::Zero());
  return {T_a_b.T * T_b_c.T,
          J_ab * T_a_b.covariance * J_ab.transpose() + J_bc * T_b_c.covariance * J_bc.transpose()};
}

UncertainTransform motionOfBase(const UncertainTransform& camera_motion,
                                const Eigen::Isometry3d& T_base_camera) {
  const Eigen::Isometry3d T = T_base_camera * camera_motion.T * T_base_camera.inverse();
  const Eigen::Matrix3d R = T_base_camera.linear();
  // t_base = R t_camera + lever - R_base lever: a rotation error swings the lever.
  const Matrix6d J = jacobian(R, skew(T.linear() * T_base_camera.translation()) * R);
  return {T, J * camera_motion.covariance * J.transpose()};
}

UncertainTwist twistOf(const UncertainTransform& T_prev_cur, double dt_s) {
  return {logMotion(T_prev_cur.T) / dt_s, T_prev_cur.covariance / (dt_s * dt_s)};
}

}  // namespace rotrocc
