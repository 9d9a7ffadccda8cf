#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// Predicts motion by constant linear and angular velocity: the last motion, scaled to the actual
/// time step.
class MotionModel {
 public:
  /// The last motion predicts no more than `max_age_s`.
  explicit MotionModel(double max_age_s) : max_age_s_(max_age_s) {}

  /// Keeps the velocity.
  void setMaxAge(double max_age_s) { max_age_s_ = max_age_s; }

  /// Stores the velocity of a measured motion that took `dt_s` > 0.
  void update(const Eigen::Isometry3d& T_prev_cur, double dt_s) {
    twist_ = logMotion(T_prev_cur) / dt_s;
  }

  /// The predicted motion during `dt_s` after the last update. None without an update, or if `dt_s`
  /// exceeds the largest age. A measured rotation R_last_cur replaces the predicted one. The
  /// velocity turns with the camera, as that of a vehicle does: then it keeps its direction in the
  /// camera's axes.
  std::optional<Eigen::Isometry3d> predict(
      double dt_s, const std::optional<Eigen::Matrix3d>& measured_rotation = std::nullopt) const {
    if (!twist_ || dt_s > max_age_s_) return std::nullopt;
    Vector6d motion = *twist_ * dt_s;
    if (measured_rotation) motion.tail<3>() = logRotation(*measured_rotation);
    return expMotion(motion);
  }

  void reset() { twist_.reset(); }

 private:
  double max_age_s_;
  std::optional<Vector6d> twist_;  ///< [m/s; rad/s]
};

}  // namespace rotrocc
