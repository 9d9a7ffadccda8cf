#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "rotrocc/odometry_config.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// Constant turn rate and velocity: the last motion goes on, scaled to the time that really passed.
class MotionModel {
 public:
  using Config = MotionModelConfig;

  explicit MotionModel(const Config& config) : config_(config) {}

  /// Takes other parameters; the motion stays.
  void configure(const Config& config) { config_ = config; }

  /// Takes a measured motion that took `dt_s` > 0.
  void update(const Eigen::Isometry3d& T_prev_cur, double dt_s);

  /// The motion expected in the `dt_s` after the last update; none if nothing is known or it is too
  /// old.
  std::optional<Eigen::Isometry3d> predict(double dt_s) const;

  void reset() { twist_.reset(); }

 private:
  Config config_;
  std::optional<Vector6d> twist_;  ///< [m/s; rad/s]
};

}  // namespace rotrocc
