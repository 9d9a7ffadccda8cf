#include "rotrocc/uncertain_transform.h"

namespace rotrocc {
namespace {

/// The Jacobian of an error whose two parts are rotated by R, and whose rotation also changes the
/// translation.
Matrix6d jacobian(const Eigen::Matrix3d& R, const Eigen::Matrix3d& translation_by_rotation) {
  Matrix6d J;
  J << R, translation_by_rotation, Eigen::Matrix3d::Zero(), R;
  return J;
}

}  // namespace

UncertainTransform compose(const UncertainTransform& T_a_b, const UncertainTransform& T_b_c) {
  const Eigen::Matrix3d R = T_a_b.T.linear();
  // A rotation error of T_a_b also moves c, by the lever arm from b to c.
  const Matrix6d J_ab = jacobian(Eigen::Matrix3d::Identity(), -skew(R * T_b_c.T.translation()));
  const Matrix6d J_bc = jacobian(R, Eigen::Matrix3d::Zero());
  return {T_a_b.T * T_b_c.T,
          J_ab * T_a_b.covariance * J_ab.transpose() + J_bc * T_b_c.covariance * J_bc.transpose()};
}

UncertainTransform inverse(const UncertainTransform& T_a_b) {
  // R^T Exp(-e) = Exp(-R^T e) R^T and t_b_a = -R^T t: a rotation error also rotates t_b_a.
  const Eigen::Matrix3d R_b_a = T_a_b.T.linear().transpose();
  const Matrix6d J = jacobian(-R_b_a, -R_b_a * skew(T_a_b.T.translation()));
  return {T_a_b.T.inverse(), J * T_a_b.covariance * J.transpose()};
}

}  // namespace rotrocc
