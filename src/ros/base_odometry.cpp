#include "base_odometry.h"

#include <algorithm>

namespace rotrocc {
namespace {

/// Variance [m^2, rad^2] of the first pose, which defines the odom frame: not zero, as filters
/// invert it.
constexpr double kFirstVariance = 1e-9;
/// Variance of a twist that is unknown, as users of nav_msgs/Odometry know it.
constexpr double kUnknownVariance = 9999.0;

}  // namespace

BaseOdometry::BaseOdometry(const Eigen::Isometry3d& T_base_camera,
                           double lost_speed_sigma_mps,
                           double lost_turn_rate_sigma_rps)
    : T_base_camera_(T_base_camera),
      T_camera_base_(T_base_camera.inverse()),
      lost_speed_sigma_mps_(lost_speed_sigma_mps),
      lost_turn_rate_sigma_rps_(lost_turn_rate_sigma_rps) {
  T_odom_base_.covariance = kFirstVariance * Matrix6d::Identity();
}

BaseState BaseOdometry::add(const OdometryResult& result) {
  BaseState state;
  state.stamp_ns = result.stamp_ns;
  state.T_first_camera = camera_.add(result.T_prev_cur);
  if (result.hasMotion()) {
    const UncertainTransform motion =
        motionOfBase({result.T_prev_cur, result.covariance}, T_base_camera_);
    T_odom_base_ = compose(T_odom_base_, motion);
    state.twist = twistOf(motion, result.dt_s);
    without_motion_s_ = 0.0;
  } else {
    T_odom_base_.covariance += growthWithoutMotion(result.stamp_ns);
    state.twist.covariance = kUnknownVariance * Matrix6d::Identity();
  }
  // Not by compose(), which would add up rounding errors of its own.
  T_odom_base_.T = T_base_camera_ * state.T_first_camera * T_camera_base_;
  state.T_odom_base = T_odom_base_;
  last_stamp_ns_ = result.stamp_ns;
  return state;
}

/// What is to be added to the covariance, so that the standard deviation grows linearly with time
/// however often this is called.
Matrix6d BaseOdometry::growthWithoutMotion(std::int64_t stamp_ns) {
  const std::int64_t passed_ns = last_stamp_ns_ ? stamp_ns - *last_stamp_ns_ : 0;
  const double before_s = without_motion_s_;
  without_motion_s_ += 1e-9 * static_cast<double>(std::max<std::int64_t>(passed_ns, 0));
  const double growth_s2 = without_motion_s_ * without_motion_s_ - before_s * before_s;
  Vector6d variances;
  variances.head<3>().setConstant(lost_speed_sigma_mps_ * lost_speed_sigma_mps_ * growth_s2);
  variances.tail<3>().setConstant(lost_turn_rate_sigma_rps_ * lost_turn_rate_sigma_rps_ *
                                  growth_s2);
  return variances.asDiagonal();
}

}  // namespace rotrocc
