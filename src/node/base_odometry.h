#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Geometry>

#include "node/base_motion.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Where the robot is after a stereo pair, and how it moves.
struct BaseState {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_first_camera =
      Eigen::Isometry3d::Identity();  ///< in the first camera's frame
  UncertainTransform T_odom_base;
  UncertainTwist twist;  ///< in axes of the base
};

/// Adds up the camera's motions to the odometry of the base that it is fixed to. The odom frame is
/// that of the base at the first pair.
///
/// While there is no motion the pose stays, the twist is zero with a covariance that says it is
/// unknown, and the standard deviation of the pose grows with the time that has passed.
class BaseOdometry {
 public:
  /// `lost_speed_sigma_mps` and `lost_turn_rate_sigma_rps`: the growth, along and about each axis.
  /// `planar`: the base moves along its x and y and turns about its z only; what else is measured
  /// is left out.
  BaseOdometry(const Eigen::Isometry3d& T_base_camera,
               double lost_speed_sigma_mps,
               double lost_turn_rate_sigma_rps,
               bool planar = false);

  BaseState add(const OdometryResult& result);

  /// The base is there, for certain. The camera's trajectory goes on as if nothing had happened.
  void setPose(const Eigen::Isometry3d& T_odom_base);

 private:
  UncertainTransform motionOfBase(const Eigen::Isometry3d& T, const Matrix6d& covariance) const;
  void addMotion(const OdometryResult& result, const UncertainTransform& step);
  Matrix6d growthWithoutMotion(std::int64_t stamp_ns);
  Eigen::Isometry3d T_start_base() const;

  Eigen::Isometry3d T_base_camera_;
  Eigen::Isometry3d T_camera_base_;
  Eigen::Isometry3d T_odom_start_ = Eigen::Isometry3d::Identity();  // start: the base's first pose
  double lost_speed_sigma_mps_;
  double lost_turn_rate_sigma_rps_;
  bool planar_;

  PoseAccumulator camera_;
  UncertainTransform T_odom_base_;
  std::optional<std::int64_t> last_stamp_ns_;

  // Errors add up from keyframe to keyframe.
  std::optional<std::int64_t> keyframe_stamp_ns_;
  std::optional<UncertainTransform>
      T_odom_keyframe_;              // none after setPose(), until the next keyframe
  std::int64_t known_stamp_ns_ = 0;  // of the last pair with a motion ...
  UncertainTransform T_odom_known_;  // ... and the base's pose then
  double without_motion_s_ = 0.0;
};

}  // namespace rotrocc
