#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "input/log.h"
#include "input/stereo_intake.h"
#include "input/stereo_pair_converter.h"
#include "node/base/base_odometry.h"
#include "node/health/pair_inspector.h"
#include "rotrocc/parameters.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// A pair with all that is known of it.
struct PairInput {
  StereoPair pair;                                ///< gray and rectified
  std::chrono::steady_clock::time_point arrival;  ///< of the pair
  StereoCamera camera;
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();  ///< at the stamp of the pair
  /// The motion of the base since the previous pair by another odometry, if any. It predicts the
  /// motion of the pair, and moves the pose while the motion is lost.
  std::optional<Eigen::Isometry3d> T_last_base = std::nullopt;
  /// Of the camera, see VisualOdometry::process().
  RotationSource measured_rotation = {};
  /// The vertical in axes of the camera, if it is known. Called for a first pose.
  std::function<std::optional<Eigen::Vector3d>()> up = {};
  /// Whether the time is simulated: only cameras without noise have the same image twice at rest.
  bool is_simulated = false;
  std::vector<std::shared_ptr<const ReceivedPair>> before = {};  ///< see ReceivedPair
};

/// Result of a pair.
struct PairAnswer {
  OdometryResult result;
  BaseState state;
  std::string mount_problem;       ///< see BaseOdometry::planarProblem()
  bool starts_trajectory = false;  ///< a new trajectory: after a reset, a time jump or a long loss
};

/// Converts pairs to odometry of the base, in one thread, and rectifies those that are raw. Begins
/// at initial_pose. Other threads may request changes, which takeRequests() takes over for the next
/// pair; requests do not block.
class PairProcessor {
 public:
  explicit PairProcessor(const Parameters& parameters, Log log = Log());

  /// See StereoPairConverter::convert().
  StereoPair convert(const ReceivedPair& received) { return converter_.convert(received); }

  /// Takes over what was requested so far, for the next call of process(). Returns whether there is
  /// a new request for a reset, after which the sensors may have other poses.
  bool takeRequests();

  /// Whether the next pair is the first one, and roll and pitch of its pose are by the vertical.
  bool startsLevel() const { return !base_odometry_ && isLevelled(); }

  /// The result is as PairInspector::distrusted() has it.
  PairAnswer process(const PairInput& in);

  /// The suspected camera fault after each pair, in one sentence; empty if none. Apart from
  /// process(), so that the odometry need not wait for it.
  std::string inspect(const PairInput& in);
  /// Waits until the next call of inspect() knows all that the last one has begun to look for.
  void finishInspection() { inspector_.finish(); }

  /// Prepares for the next pair, see VisualOdometry::prepare().
  void prepare() { odometry_.prepare(); }

  const VisualOdometry& odometry() const { return odometry_; }

  // Thread-safe requests.

  /// Sets the pose to the initial one; the next pair is a first one.
  void requestReset() { request({true, false, std::nullopt, std::nullopt}); }
  /// The next pair is a first one; the pose is kept.
  void requestRestart() { request({false, true, std::nullopt, std::nullopt}); }
  /// Sets the pose of the base at the time of the last pair. If that was lost, the next pair is a
  /// first one.
  void requestPose(const UncertainTransform& T_odom_base) {
    request({false, false, T_odom_base, std::nullopt});
  }
  /// From the next pair on; the pose, the previous pair and what is known of the rig are kept, see
  /// VisualOdometry::configure().
  void requestConfig(const VisualOdometry::Config& config) {
    request({false, false, std::nullopt, config});
  }

 private:
  struct Requests {
    bool reset = false;
    bool restart = false;
    std::optional<UncertainTransform> T_odom_base;
    std::optional<VisualOdometry::Config> config;

    void add(const Requests& later);
  };

  void request(const Requests& requests);
  bool isLevelled() const;
  void begin(const PairInput& in);
  bool restartIfNeeded(const Requests& requests, const PairInput& in);
  bool restart(const std::string& why, const std::string& parameter, const std::string& pose);
  bool moves(const PairInput& in) const;

  Log log_;
  NodeParameters parameters_;
  SystematicErrorConfig systematic_error_;
  StereoPairConverter converter_;
  VisualOdometry odometry_;
  PairInspector inspector_;
  std::optional<BaseOdometry> base_odometry_;  // from the first pair on
  bool logged_mount_ = false;
  std::optional<StereoPair> last_;  // without its images
  OdometryResult estimated_;        // of the last pair, also if it is no pair
  std::chrono::steady_clock::time_point last_arrival_;

  Requests taken_;  // for the next pair

  std::mutex requests_mutex_;
  Requests requests_;
};

}  // namespace rotrocc
