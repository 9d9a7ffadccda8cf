#include "node/base/base_odometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/to_seconds.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

/// Variance [m^2, rad^2] of the first pose, which defines the odom frame; not zero, because filters
/// invert it.
constexpr double kFirstVariance = 1e-9;
/// Variance [m^2, rad^2] of the components that planar motion excludes.
constexpr double kPlanarVariance = 1e-9;
constexpr double kPlanarShare = 0.5;
/// Variance [rad^2] of roll and pitch by gravity: 0.1 m/s^2 of bias are usual.
constexpr double kLevelVariance = 1e-4;
/// Longer gaps do not increase the uncertainty further: filters need finite numbers.
constexpr double kMaxWithoutMotion_s = 1000.0;

/// Part of a rotation's error that comes with the way: wheels that slip turn a base that drives
/// straight on.
constexpr double kTurn_radpm = 0.1;
/// Standard deviation of another odometry's motion, as a share of way and angle: wheels slip.
constexpr double kGuessErrorShare = 0.1;

// What a robot may do unseen: speeds up by 1.4 m/s and 0.7 rad/s in a second, as a car that starts
// and a robot that turns on the spot. One that was never faster than a walk stays so.
constexpr double kSpeedVariance = 2.0;     // per second [m^2/s^3]
constexpr double kTurnRateVariance = 0.5;  // [rad^2/s^3]
constexpr double kWalk_mps = 1.0;
constexpr double kTurn_rps = 0.5;

/// From x y z roll pitch yaw.
Eigen::Isometry3d poseOf(const std::array<double, 6>& values) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << values[0], values[1], values[2];
  T.rotate(Eigen::AngleAxisd(values[5], Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(values[4], Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(values[3], Eigen::Vector3d::UnitX()));
  return T;
}

/// Of equal variances of each axis.
Matrix6d diagonal(double translation, double rotation) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return variances.asDiagonal();
}

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

/// Of velocities whose motion took `dt_s`, between two stamps that err by `sigma_s` each.
UncertainTwist velocityOf(const Vector6d& motion,
                          const Matrix6d& covariance,
                          double dt_s,
                          double sigma_s) {
  const Vector6d velocity = motion / dt_s;
  const double variance_s2 = 2.0 * sigma_s * sigma_s;
  return {velocity, (covariance + variance_s2 * velocity * velocity.transpose()) / (dt_s * dt_s)};
}

/// The constant twist of a motion. The covariance is valid for small rotations within that time.
UncertainTwist twistOf(const UncertainTransform& T_prev_cur, double dt_s, double sigma_s) {
  return velocityOf(logMotion(T_prev_cur.T), T_prev_cur.covariance, dt_s, sigma_s);
}

/// Translation and rotation of a motion over time, in the frame before it.
UncertainTwist meanVelocityOf(const UncertainTransform& T_prev_cur, double dt_s, double sigma_s) {
  Vector6d motion;
  motion << T_prev_cur.T.translation(), logRotation(T_prev_cur.T.linear());
  return velocityOf(motion, T_prev_cur.covariance, dt_s, sigma_s);
}

}  // namespace

BaseOdometry::BaseOdometry(const NodeParameters& parameters,
                           const SystematicErrorConfig& systematic_error,
                           const std::optional<Eigen::Vector3d>& up)
    : parameters_(parameters),
      systematic_error_(systematic_error),
      speed_{kSpeedVariance, kWalk_mps},
      turn_rate_{kTurnRateVariance, kTurn_rps} {
  std::array<double, 6> pose = parameters.initial_pose;
  Matrix6d covariance = Matrix6d::Zero();
  if (up) {
    pose[3] = std::atan2(up->y(), up->z());
    pose[4] = std::atan2(-up->x(), std::hypot(up->y(), up->z()));
    covariance(3, 3) = covariance(4, 4) = kLevelVariance;
  }
  setPose({poseOf(pose), covariance});
}

BaseState BaseOdometry::add(const OdometryResult& result,
                            const Eigen::Isometry3d& T_base_camera,
                            const std::optional<Eigen::Isometry3d>& T_last_cur) {
  BaseState state;
  state.stamp_ns = result.stamp_ns;
  const bool first = !T_start_camera_;
  if (first) {
    last_.T_base_camera = T_base_camera;
    T_start_camera_ = T_base_camera;
    if (!last_.time_ns) last_.time_ns = result.time_ns();
    last_measured_ = last_;
  }
  if (result.hasMotion()) {
    const UncertainTransform step = addMotion(result, T_base_camera);
    state.twist = twistOf(step, result.dt_s(), result.stamp_sigma_s);
    speed_.set(state.twist.twist.head<3>().norm());
    turn_rate_.set(state.twist.twist.tail<3>().norm());
    state.step_velocity = {result.prev_stamp_ns,
                           meanVelocityOf(step, result.dt_s(), result.stamp_sigma_s)};
  } else {
    addUnseen(result, T_base_camera, first ? std::nullopt : T_last_cur);
    state.twist.covariance = kUnknownVariance * Matrix6d::Identity();
  }
  if (parameters_.planar) last_.T_odom_base.covariance = planar(last_.T_odom_base.covariance);
  if (result.state != State::kLost) {
    startFromLast();
    lost_since_ns_.reset();
  } else {
    if (T_measured_last_ && T_last_cur) {
      T_measured_last_ = *T_measured_last_ * *T_last_cur;
    } else {
      T_measured_last_.reset();
    }
    if (!lost_since_ns_) lost_since_ns_ = result.time_ns();
  }
  state.T_first_camera = last_.T_first_start * camera_.T_first_cur();
  state.T_odom_base = withSystematicError(last_.T_odom_base);
  return state;
}

void BaseOdometry::startFromLast() {
  last_measured_ = last_;
  T_measured_last_ = Eigen::Isometry3d::Identity();
}

std::optional<Eigen::Isometry3d> BaseOdometry::expectedMotion(
    const Eigen::Isometry3d& T_base_camera,
    const std::optional<Eigen::Isometry3d>& T_last_cur) const {
  if (!T_measured_last_ || !T_last_cur) return std::nullopt;
  const Eigen::Isometry3d T_measured_base = *T_measured_last_ * *T_last_cur;
  return last_measured_.T_base_camera.inverse() * T_measured_base * T_base_camera;
}

/// Where `camera_motion` is T_prev_cur of the camera.
UncertainTransform BaseOdometry::motionOfBase(const UncertainTransform& camera_motion,
                                              const Eigen::Isometry3d& T_base_camera_prev,
                                              const Eigen::Isometry3d& T_base_camera_cur) const {
  const UncertainTransform motion =
      compose(compose({T_base_camera_prev}, camera_motion), {T_base_camera_cur.inverse()});
  return parameters_.planar ? UncertainTransform{planar(motion.T), planar(motion.covariance)}
                            : motion;
}

/// Returns the motion of the base since the previous pair.
UncertainTransform BaseOdometry::addMotion(const OdometryResult& result,
                                           const Eigen::Isometry3d& T_base_camera) {
  const Pose prev =
      result.prev_time_ns() > *last_measured_.time_ns ? last_ : last_measured_;  // a lost pair
  if (result.keyframe_stamp_ns != keyframe_stamp_ns_) {
    keyframe_stamp_ns_ = result.keyframe_stamp_ns;
    keyframe_ = prev;
  }
  const UncertainTransform camera_step = {result.T_prev_cur, result.covariance};
  const UncertainTransform step = motionOfBase(camera_step, prev.T_base_camera, T_base_camera);
  moved_m_ +=
      (prev.T_base_camera * result.T_prev_cur * T_base_camera.inverse()).translation().norm();
  planar_m_ += step.T.translation().norm();
  camera_.add(parameters_.planar ? prev.T_base_camera.inverse() * step.T * T_base_camera
                                 : result.T_prev_cur);
  last_ = prev;
  last_.time_ns = result.time_ns();
  last_.T_base_camera = T_base_camera;
  const Pose& from = keyframe_ ? *keyframe_ : prev;
  last_.T_odom_base = compose(
      from.T_odom_base,
      motionOfBase(
          keyframe_ ? result.T_keyframe_cur : camera_step, from.T_base_camera, T_base_camera));
  // Not by compose(), which would accumulate rounding errors.
  last_.T_odom_base.T = last_.T_odom_start * T_start_base();
  without_motion_s_ = guessed_m_ = guessed_rad_ = 0.0;
  return step;
}

/// The base moves by `T_last_cur`, or rests; the camera may move on it.
void BaseOdometry::addUnseen(const OdometryResult& result,
                             const Eigen::Isometry3d& T_base_camera,
                             const std::optional<Eigen::Isometry3d>& T_last_cur) {
  UncertainTransform step;
  if (T_last_cur) step.T = parameters_.planar ? planar(*T_last_cur) : *T_last_cur;
  last_.T_odom_base = compose(last_.T_odom_base, step);
  last_.T_odom_base.covariance +=
      T_last_cur ? growthWithDistance(step.T)
                 : growthWithTime(toSeconds(result.time_ns() - *last_.time_ns));
  camera_.add(Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d before = std::exchange(last_.T_base_camera, T_base_camera);
  if (T_last_cur || T_base_camera.matrix() != before.matrix()) {
    const Eigen::Isometry3d T_camera_step = before.inverse() * step.T * T_base_camera;
    const Eigen::Isometry3d& T_visual = camera_.T_first_cur();
    last_.T_first_start = last_.T_first_start * T_visual * T_camera_step * T_visual.inverse();
    last_.T_odom_start = last_.T_odom_base.T * T_start_base().inverse();
  }
  last_.T_odom_base.T = last_.T_odom_start * T_start_base();
  last_.time_ns = result.time_ns();
}

std::string BaseOdometry::planarProblem() const {
  // Of noise at rest, two of three directions are left.
  if (planar_m_ > kPlanarShare * moved_m_ || moved_m_ < kWalk_mps) return "";
  return "planar has removed most of the motion, " + toText(moved_m_ - planar_m_, 3) + " of " +
         toText(moved_m_, 3) +
         " m: does the base move in its plane, and is the tf of the camera right?";
}

void BaseOdometry::addTimeUnseen(double time_s) {
  last_.T_odom_base.covariance += growthWithTime(time_s);
}

void BaseOdometry::setPose(const UncertainTransform& T_odom_base) {
  last_.T_odom_start = T_start_camera_ ? T_odom_base.T * T_start_base().inverse() : T_odom_base.T;
  T_odom_first_ = T_odom_base.T;
  last_.T_odom_base = T_odom_base;
  last_.T_odom_base.covariance += kFirstVariance * Matrix6d::Identity();
  last_measured_ = last_;
  keyframe_.reset();
  without_motion_s_ = guessed_m_ = guessed_rad_ = 0.0;
}

UncertainTransform BaseOdometry::withSystematicError(const UncertainTransform& T_odom_base) const {
  const Eigen::Isometry3d T_first_base = T_odom_first_.inverse() * T_odom_base.T;
  const Matrix6d systematic =
      compose({T_odom_first_}, {T_first_base, systematic_error_.covarianceOf(T_first_base)})
          .covariance;
  return {T_odom_base.T,
          T_odom_base.covariance + (parameters_.planar ? planar(systematic) : systematic)};
}

/// The visual pose of the base at the last pair, in its frame at the first one.
Eigen::Isometry3d BaseOdometry::T_start_base() const {
  return *T_start_camera_ * camera_.T_first_cur() * last_.T_base_camera.inverse();
}

void BaseOdometry::Speed::set(double speed) {
  last = speed;
  fastest = std::max(fastest, speed);
}

/// By the last speed and its random walk, which does not get faster than what was seen.
double BaseOdometry::Speed::wayVariance(double time_s) const {
  const double change2 = std::min(variance_per_s * time_s / 3.0, fastest * fastest);
  return time_s * time_s * (last * last + change2);
}

/// Increment of the covariance, so that its growth does not depend on the rate of calls.
Matrix6d BaseOdometry::growthWithTime(double time_s) {
  const double before_s = without_motion_s_;
  without_motion_s_ += std::max(time_s, 0.0);
  without_motion_s_ = std::min(without_motion_s_, kMaxWithoutMotion_s);
  return diagonal(speed_.wayVariance(without_motion_s_) - speed_.wayVariance(before_s),
                  turn_rate_.wayVariance(without_motion_s_) - turn_rate_.wayVariance(before_s));
}

/// The same for the distance that another odometry reports.
Matrix6d BaseOdometry::growthWithDistance(const Eigen::Isometry3d& T_last_cur) {
  const double before_m = guessed_m_;
  const double before_rad = guessed_rad_;
  const double distance_m = T_last_cur.translation().norm();
  guessed_m_ += distance_m;
  guessed_rad_ += logRotation(T_last_cur.linear()).norm() + kTurn_radpm * distance_m;
  const double share2 = kGuessErrorShare * kGuessErrorShare;
  return diagonal(share2 * (guessed_m_ * guessed_m_ - before_m * before_m),
                  share2 * (guessed_rad_ * guessed_rad_ - before_rad * before_rad));
}

}  // namespace rotrocc
