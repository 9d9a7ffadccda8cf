#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "rotrocc/parameters.h"
#include "rotrocc/pose_accumulator.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/uncertain_transform.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Variance of what is unknown, by convention of nav_msgs/Odometry.
constexpr double kUnknownVariance = 9999.0;

/// Velocities [m/s, rad/s] of a body in its own frame, with covariance.
struct UncertainTwist {
  Vector6d twist = Vector6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();
};

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

/// Accumulates camera motions to the odometry of the base, from the initial pose at the first pair.
/// The camera may move on the base.
///
/// Without a motion, the base moves as another odometry reports, and the standard deviation of the
/// pose grows with its way; if there is none, the base is assumed at rest, and it grows by the way
/// that the base may make in the time. The twist is zero with a very large covariance.
class BaseOdometry {
 public:
  /// Of `parameters`: initial_pose; planar, which discards other components of a motion.
  /// `systematic_error`: its part of the pose covariance is in proportion to the distance from the
  /// first pose. `up`: the vertical in axes of the base at the first pair; if it is known, roll and
  /// pitch are by it.
  BaseOdometry(const NodeParameters& parameters,
               const SystematicErrorConfig& systematic_error,
               const std::optional<Eigen::Vector3d>& up = std::nullopt);

  /// `T_base_camera`: the pose of the camera on the base at the pair. `T_last_cur`: motion of the
  /// base since the last pair by another odometry, if any.
  BaseState add(const OdometryResult& result,
                const Eigen::Isometry3d& T_base_camera,
                const std::optional<Eigen::Isometry3d>& T_last_cur = std::nullopt);

  /// The motion of the camera since the last pair that was not lost, for add() of a later pair with
  /// these arguments; nothing unless the other odometry has reported all of it.
  std::optional<Eigen::Isometry3d> expectedMotion(
      const Eigen::Isometry3d& T_base_camera,
      const std::optional<Eigen::Isometry3d>& T_last_cur) const;

  /// The next motion is measured from the last pair, although that was lost.
  void startFromLast();

  /// The first pair of the present loss, see OdometryResult::time_ns(); nothing if the last pair
  /// was not lost.
  const std::optional<std::int64_t>& lost_since_ns() const { return lost_since_ns_; }

  /// Time that passed since the last pair, apart from what the stamps say.
  void addTimeUnseen(double time_s);

  /// That planar removes most of the motion, in one sentence with a remedy; empty if it does not.
  std::string planarProblem() const;

  void setSystematicError(const SystematicErrorConfig& config) { systematic_error_ = config; }

  /// Sets the pose of the base at the last pair. The camera's trajectory is not affected.
  void setPose(const UncertainTransform& T_odom_base);

 private:
  /// What later pairs are measured against.
  struct Pose {
    std::optional<std::int64_t> time_ns;  // see OdometryResult
    Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
    UncertainTransform T_odom_base;  // without systematic errors
    // What is added to the visual poses of base and camera: by setPose(), and by motions of the
    // base or the camera on it that were not seen.
    Eigen::Isometry3d T_odom_start = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d T_first_start = Eigen::Isometry3d::Identity();
  };

  /// Speed [m/s] or turn rate [rad/s] of the base.
  struct Speed {
    double variance_per_s;  ///< by which it changes
    double fastest;         ///< so far; at first, what any robot may reach
    double last = 0.0;      ///< at the last motion

    void set(double speed);
    /// Variance of the way or angle that nothing measures in that time.
    double wayVariance(double time_s) const;
  };

  UncertainTransform motionOfBase(const UncertainTransform& camera_motion,
                                  const Eigen::Isometry3d& T_base_camera_prev,
                                  const Eigen::Isometry3d& T_base_camera_cur) const;
  UncertainTransform addMotion(const OdometryResult& result,
                               const Eigen::Isometry3d& T_base_camera);
  void addUnseen(const OdometryResult& result,
                 const Eigen::Isometry3d& T_base_camera,
                 const std::optional<Eigen::Isometry3d>& T_last_cur);
  Matrix6d growthWithTime(double time_s);
  Matrix6d growthWithDistance(const Eigen::Isometry3d& T_last_cur);
  UncertainTransform withSystematicError(const UncertainTransform& T_odom_base) const;
  Eigen::Isometry3d T_start_base() const;

  NodeParameters parameters_;
  SystematicErrorConfig systematic_error_;

  PoseAccumulator camera_;                           // visual poses
  std::optional<Eigen::Isometry3d> T_start_camera_;  // at the first pair
  Pose last_;                                        // of the last pair
  Pose last_measured_;  // of the last pair that was not lost; equal to last_ if that was not
  std::optional<Eigen::Isometry3d>
      T_measured_last_;  // by the other odometry, if it reported all of it
  std::optional<std::int64_t> lost_since_ns_;
  Eigen::Isometry3d T_odom_first_ = Eigen::Isometry3d::Identity();  // initial, or set

  // Errors accumulate from keyframe to keyframe.
  std::optional<std::int64_t> keyframe_stamp_ns_;
  std::optional<Pose> keyframe_;  // none after setPose(), until the next keyframe
  Speed speed_;
  Speed turn_rate_;
  // By all motions: of them, and what planar leaves.
  double moved_m_ = 0.0;
  double planar_m_ = 0.0;
  // Since the last motion.
  double without_motion_s_ = 0.0;
  double guessed_m_ = 0.0;
  double guessed_rad_ = 0.0;
};

}  // namespace rotrocc
