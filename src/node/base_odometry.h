#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "node/base_motion.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Pose and motion of the robot after a stereo pair.
struct BaseState {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_first_camera =
      Eigen::Isometry3d::Identity();  ///< in the first camera's frame
  UncertainTransform T_odom_base;
  UncertainTwist twist;  ///< in the frame of the base
};

/// Accumulates camera motions to the odometry of the base. The odom frame is the frame of the base
/// at the first pair.
///
/// Without a motion the pose is held, the twist is zero with a very large covariance, and the
/// standard deviation of the pose grows with time.
class BaseOdometry {
 public:
  /// `lost_speed_sigma_mps` and `lost_turn_rate_sigma_rps`: the growth, along and about each axis.
  /// `planar`: restricts the motion of the base to x, y and yaw; other components are discarded.
  /// `systematic_error`: its part of the pose covariance is in proportion to the distance from the
  /// first pose.
  BaseOdometry(const Eigen::Isometry3d& T_base_camera,
               double lost_speed_sigma_mps,
               double lost_turn_rate_sigma_rps,
               bool planar = false,
               const SystematicErrorConfig& systematic_error = {0.0, 0.0});

  BaseState add(const OdometryResult& result);

  void setSystematicError(const SystematicErrorConfig& config) { systematic_error_ = config; }

  /// Sets the pose of the base, without uncertainty. The camera's trajectory is not affected.
  void setPose(const Eigen::Isometry3d& T_odom_base);

 private:
  UncertainTransform motionOfBase(const Eigen::Isometry3d& T, const Matrix6d& covariance) const;
  void addMotion(const OdometryResult& result, const UncertainTransform& step);
  Matrix6d growthWithoutMotion(std::int64_t stamp_ns);
  UncertainTransform withSystematicError(const UncertainTransform& T_odom_base) const;
  Eigen::Isometry3d T_start_base() const;

  Eigen::Isometry3d T_base_camera_;
  Eigen::Isometry3d T_camera_base_;
  Eigen::Isometry3d T_odom_start_ = Eigen::Isometry3d::Identity();  // start: the base's first pose
  double lost_speed_sigma_mps_;
  double lost_turn_rate_sigma_rps_;
  bool planar_;
  SystematicErrorConfig systematic_error_;

  PoseAccumulator camera_;
  UncertainTransform T_odom_base_;                                  // without systematic errors
  Eigen::Isometry3d T_odom_first_ = Eigen::Isometry3d::Identity();  // pose without uncertainty
  std::optional<std::int64_t> last_stamp_ns_;

  // Errors accumulate from keyframe to keyframe.
  std::optional<std::int64_t> keyframe_stamp_ns_;
  std::optional<UncertainTransform>
      T_odom_keyframe_;              // none after setPose(), until the next keyframe
  std::int64_t known_stamp_ns_ = 0;  // of the last pair with a motion ...
  UncertainTransform T_odom_known_;  // ... and the base's pose then
  double without_motion_s_ = 0.0;
};

}  // namespace rotrocc
