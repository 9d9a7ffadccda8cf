#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "input/log.h"
#include "input/stereo_intake.h"
#include "input/stereo_pair_converter.h"
#include "node/base/base_odometry.h"
#include "node/base/pose_file.h"
#include "node/health/pair_inspector.h"
#include "rotrocc/parameters.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// What is known of a pair beside its images.
struct PairContext {
  StereoCamera camera;
  /// The mount at the stamp of the pair.
  UncertainTransform T_base_camera;
  /// The motion of the base since the pair before by another odometry, if any. It predicts the
  /// motion of the pair, and moves the pose while the motion is lost.
  std::optional<Eigen::Isometry3d> T_last_base = std::nullopt;
  /// Of the camera, see VisualOdometry::process().
  RotationSource measured_rotation = {};
  /// Whether the time is simulated: only cameras without noise have the same image twice at rest.
  bool is_simulated = false;
  /// The vertical in axes of the camera, if it is known. Called for a first pose.
  std::function<std::optional<Eigen::Vector3d>()> up = {};
};

/// Result of a pair.
struct PairAnswer {
  StereoPair pair;  ///< rectified; valid until the next call of convert()
  StereoCamera camera;
  OdometryResult result;
  BaseState state;
  bool starts_trajectory = false;  ///< a new trajectory: after a reset, a time jump or a long loss
};

/// Converts pairs to odometry of the base, in one thread, and rectifies those that are raw. Begins
/// at the pose of the file continue_from, or else at initial_pose. Other threads may request
/// changes, which takeRequests() takes over for the next pair; requests do not block.
class PairProcessor {
 public:
  /// Throws std::exception with one sentence if continue_from cannot be a file.
  explicit PairProcessor(const Parameters& parameters, Log log = Log());

  /// See StereoPairConverter::convert().
  StereoPair convert(const ReceivedPair& received) { return converter_.convert(received); }

  /// Takes over what was requested so far, for the next call of process(). Returns whether there is
  /// a new request for a reset. To be called before the mount is looked up: after a reset, a new
  /// one may be used.
  bool takeRequests();

  /// Whether the next pair is the first one, and roll and pitch of its pose are by the vertical.
  bool startsLevel() const { return !base_odometry_ && !saved_ && isLevelled(); }

  PairAnswer process(const StereoPair& pair, const PairContext& context);

  /// The suspected camera fault after each pair, in one sentence; empty if none. Apart from
  /// process(), so that the odometry need not wait for it.
  std::string inspect(const PairAnswer& answer) {
    return inspector_.inspect(
        answer.pair, answer.camera, answer.result, converter_.significantBits());
  }
  /// Waits until the next call of inspect() knows all that the last one has begun to look for.
  void finishInspection() const { inspector_.finish(); }

  /// Prepares for the next pair, see VisualOdometry::prepare().
  void prepare() { odometry_.prepare(); }

  const VisualOdometry& odometry() const { return odometry_; }

  /// Thread-safe. Sets the pose to the initial one; the next pair is a first one.
  void requestReset();
  /// Thread-safe. The next pair is a first one; the pose is kept.
  void requestRestart();
  /// Thread-safe. Sets the pose of the base at the time of the last pair. If that was lost, the
  /// next pair is a first one.
  void requestPose(const UncertainTransform& T_odom_base);
  /// Thread-safe. From the next pair on; the pose, the previous pair and what is known of the rig
  /// are kept, see VisualOdometry::configure().
  void requestConfig(const VisualOdometry::Config& config);

 private:
  struct Requests {
    bool reset = false;
    bool restart = false;
    std::optional<UncertainTransform> T_odom_base;
    std::optional<VisualOdometry::Config> config;
  };

  bool isLevelled() const;
  void begin(const PairContext& context, std::int64_t stamp_ns);
  bool restartIfNeeded(const Requests& requests, std::int64_t stamp_ns);
  bool restart(const std::string& why, const std::string& parameter, const std::string& pose);
  void configure(const VisualOdometry::Config& config);
  void setPose(const UncertainTransform& T_odom_base);
  bool isFrozen(const StereoPair& pair, const PairContext& context);
  void move(const PairContext& context, PairAnswer& answer);

  Log log_;
  NodeParameters parameters_;
  SystematicErrorConfig systematic_error_;
  StereoPairConverter converter_;
  VisualOdometry odometry_;
  PairInspector inspector_;
  std::optional<PoseFile> pose_file_;
  std::optional<BaseState> saved_;             // of an earlier run, to continue from
  std::optional<BaseOdometry> base_odometry_;  // from the first pair on
  std::optional<std::int64_t> last_stamp_ns_;
  std::optional<std::int64_t> lost_since_ns_;
  // The last pair that was not lost: the mount then, and the motion by the other odometry from then
  // to the last pair, if every part of it was known.
  Eigen::Isometry3d T_base_camera_known_ = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Isometry3d> T_known_last_;

  Requests taken_;  // for the next pair

  std::mutex requests_mutex_;
  Requests requests_;
};

}  // namespace rotrocc
