#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "node/base_motion.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// The mean velocity from one pair to the next. A filter that integrates velocities from their
/// stamp on follows the motion with it; with the twist of the later pair, it lags by a period.
struct StepVelocity {
  std::int64_t stamp_ns = 0;  ///< of the first of both pairs
  UncertainTwist twist;       ///< in the frame of the base at that time
};

/// Pose and motion of the robot after a stereo pair.
struct BaseState {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_first_camera =
      Eigen::Isometry3d::Identity();  ///< in the first camera's frame
  UncertainTransform T_odom_base;
  UncertainTwist twist;                       ///< in the frame of the base
  std::optional<StepVelocity> step_velocity;  ///< since the previous pair, if known
};

/// Accumulates camera motions to the odometry of the base. The odom frame is the frame of the base
/// at the first pair. The camera may move on the base.
///
/// Without a motion the base is assumed at rest, the twist is zero with a very large covariance,
/// and the standard deviation of the pose grows with time.
class BaseOdometry {
 public:
  /// `lost_speed_sigma_mps` and `lost_turn_rate_sigma_rps`: the growth, along and about each axis.
  /// `planar`: restricts the motion of the base to x, y and yaw; other components are discarded.
  /// `systematic_error`: its part of the pose covariance is in proportion to the distance from the
  /// first pose.
  BaseOdometry(double lost_speed_sigma_mps,
               double lost_turn_rate_sigma_rps,
               bool planar = false,
               const SystematicErrorConfig& systematic_error = {0.0, 0.0});

  /// `T_base_camera`: the mount of the camera at the pair.
  BaseState add(const OdometryResult& result, const Eigen::Isometry3d& T_base_camera);

  void setSystematicError(const SystematicErrorConfig& config) { systematic_error_ = config; }

  /// Sets the pose of the base, without uncertainty. The camera's trajectory is not affected.
  void setPose(const Eigen::Isometry3d& T_odom_base);

 private:
  /// What later pairs are measured against.
  struct Pose {
    std::int64_t stamp_ns = 0;
    Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
    UncertainTransform T_odom_base;  // without systematic errors
    // What setPose(), and mounts that move while there is no motion, add to the visual poses of
    // base and camera.
    Eigen::Isometry3d T_odom_start = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d T_first_start = Eigen::Isometry3d::Identity();
  };

  UncertainTransform motionOfBase(const UncertainTransform& camera_motion,
                                  const Pose& from,
                                  const Eigen::Isometry3d& T_base_camera) const;
  UncertainTransform addMotion(const OdometryResult& result,
                               const Eigen::Isometry3d& T_base_camera);
  void addRest(const OdometryResult& result, const Eigen::Isometry3d& T_base_camera);
  Matrix6d growthWithoutMotion(std::int64_t stamp_ns);
  UncertainTransform withSystematicError(const UncertainTransform& T_odom_base) const;
  Eigen::Isometry3d T_start_base() const;

  double lost_speed_sigma_mps_;
  double lost_turn_rate_sigma_rps_;
  bool planar_;
  SystematicErrorConfig systematic_error_;

  PoseAccumulator camera_;                           // visual poses
  std::optional<Eigen::Isometry3d> T_start_camera_;  // the first mount
  Pose last_;                                        // of the last pair
  Pose known_;  // of the last pair that was not lost; equal to last_ if that was not
  Eigen::Isometry3d T_odom_first_ = Eigen::Isometry3d::Identity();  // pose without uncertainty

  // Errors accumulate from keyframe to keyframe.
  std::optional<std::int64_t> keyframe_stamp_ns_;
  std::optional<Pose> keyframe_;  // none after setPose(), until the next keyframe
  double without_motion_s_ = 0.0;
};

}  // namespace rotrocc
