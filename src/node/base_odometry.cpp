#include "node/base_odometry.h"

#include <algorithm>
#include <cmath>

#include "odometry/systematic_error.h"

namespace rotrocc {
namespace {

/// Variance [m^2, rad^2] of the first pose, which defines the odom frame; not zero, because filters
/// invert it.
constexpr double kFirstVariance = 1e-9;
/// Variance of an unknown twist, by convention of nav_msgs/Odometry.
constexpr double kUnknownVariance = 9999.0;
/// Variance [m^2, rad^2] of the components that planar motion excludes.
constexpr double kPlanarVariance = 1e-9;
/// Longer gaps do not increase the uncertainty further: filters need finite numbers.
constexpr double kMaxWithoutMotion_s = 1000.0;

/// The planar part of a motion of the base.
Eigen::Isometry3d planar(const Eigen::Isometry3d& T) {
  const double yaw_rad = std::atan2(T.linear()(1, 0), T.linear()(0, 0));
  Eigen::Isometry3d flat = Eigen::Isometry3d::Identity();
  flat.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  flat.translation().head<2>() = T.translation().head<2>();
  return flat;
}

Matrix6d planar(const Matrix6d& covariance) {
  Matrix6d flat = covariance;
  for (const int axis : {2, 3, 4}) {
    flat.row(axis).setZero();
    flat.col(axis).setZero();
    flat(axis, axis) = kPlanarVariance;
  }
  return flat;
}

}  // namespace

BaseOdometry::BaseOdometry(const Eigen::Isometry3d& T_base_camera,
                           double lost_speed_sigma_mps,
                           double lost_turn_rate_sigma_rps,
                           bool planar,
                           const SystematicErrorConfig& systematic_error)
    : T_base_camera_(T_base_camera),
      T_camera_base_(T_base_camera.inverse()),
      lost_speed_sigma_mps_(lost_speed_sigma_mps),
      lost_turn_rate_sigma_rps_(lost_turn_rate_sigma_rps),
      planar_(planar),
      systematic_error_(systematic_error) {
  T_odom_base_.covariance = kFirstVariance * Matrix6d::Identity();
}

BaseState BaseOdometry::add(const OdometryResult& result) {
  BaseState state;
  state.stamp_ns = result.stamp_ns;
  const UncertainTransform step = motionOfBase(result.T_prev_cur, result.covariance);
  state.T_first_camera =
      camera_.add(planar_ ? T_camera_base_ * step.T * T_base_camera_ : result.T_prev_cur);
  if (result.hasMotion()) {
    addMotion(result, step);
    state.twist = twistOf(step, result.dt_s);
    without_motion_s_ = 0.0;
  } else {
    T_odom_base_.covariance += growthWithoutMotion(result.stamp_ns);
    state.twist.covariance = kUnknownVariance * Matrix6d::Identity();
  }
  if (planar_) T_odom_base_.covariance = planar(T_odom_base_.covariance);
  // Not by compose(), which would accumulate rounding errors.
  T_odom_base_.T = T_odom_start_ * T_start_base();
  if (result.hasMotion()) {
    known_stamp_ns_ = result.stamp_ns;
    T_odom_known_ = T_odom_base_;
  }
  state.T_odom_base = withSystematicError(T_odom_base_);
  last_stamp_ns_ = result.stamp_ns;
  return state;
}

UncertainTransform BaseOdometry::motionOfBase(const Eigen::Isometry3d& T,
                                              const Matrix6d& covariance) const {
  const UncertainTransform motion = rotrocc::motionOfBase({T, covariance}, T_base_camera_);
  return planar_ ? UncertainTransform{planar(motion.T), planar(motion.covariance)} : motion;
}

void BaseOdometry::addMotion(const OdometryResult& result, const UncertainTransform& step) {
  if (result.keyframe_stamp_ns != keyframe_stamp_ns_) {
    keyframe_stamp_ns_ = result.keyframe_stamp_ns;
    // A lost pair can be a keyframe, too; its pose has the published uncertainty.
    T_odom_keyframe_ = keyframe_stamp_ns_ == known_stamp_ns_ ? T_odom_known_ : T_odom_base_;
  }
  T_odom_base_ =
      T_odom_keyframe_
          ? compose(*T_odom_keyframe_,
                    motionOfBase(result.T_keyframe_cur.T, result.T_keyframe_cur.covariance))
          : compose(T_odom_base_, step);
}

void BaseOdometry::setPose(const Eigen::Isometry3d& T_odom_base) {
  T_odom_start_ = T_odom_base * T_start_base().inverse();
  T_odom_first_ = T_odom_base;
  T_odom_base_.T = T_odom_base;
  T_odom_base_.covariance = kFirstVariance * Matrix6d::Identity();
  T_odom_keyframe_.reset();
  T_odom_known_ = T_odom_base_;
  without_motion_s_ = 0.0;
}

UncertainTransform BaseOdometry::withSystematicError(const UncertainTransform& T_odom_base) const {
  const Matrix6d systematic =
      systematicCovariance(systematic_error_, T_odom_first_.inverse() * T_odom_base.T);
  return {T_odom_base.T, T_odom_base.covariance + (planar_ ? planar(systematic) : systematic)};
}

Eigen::Isometry3d BaseOdometry::T_start_base() const {
  return T_base_camera_ * camera_.T_first_cur() * T_camera_base_;
}

/// Increment of the covariance, so that the standard deviation grows linearly with time for any
/// rate of calls.
Matrix6d BaseOdometry::growthWithoutMotion(std::int64_t stamp_ns) {
  const std::int64_t passed_ns = last_stamp_ns_ ? stamp_ns - *last_stamp_ns_ : 0;
  const double before_s = without_motion_s_;
  without_motion_s_ += 1e-9 * static_cast<double>(std::max<std::int64_t>(passed_ns, 0));
  without_motion_s_ = std::min(without_motion_s_, kMaxWithoutMotion_s);
  const double growth_s2 = without_motion_s_ * without_motion_s_ - before_s * before_s;
  Vector6d variances;
  variances.head<3>().setConstant(lost_speed_sigma_mps_ * lost_speed_sigma_mps_ * growth_s2);
  variances.tail<3>().setConstant(lost_turn_rate_sigma_rps_ * lost_turn_rate_sigma_rps_ *
                                  growth_s2);
  return variances.asDiagonal();
}

}  // namespace rotrocc
