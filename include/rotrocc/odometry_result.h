#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// What can be said of the motion to the current pair.
enum class State {
  kInitialising,  ///< there is no earlier pair to compare this one with
  kOk,
  kDegraded,  ///< the motion is given, but rests on few features
  kLost       ///< no motion was found
};

/// "initialising", "ok", "degraded" or "lost".
const char* toString(State state);

/// How many features are left after each stage.
struct StageCounts {
  int corners = 0;           ///< Shi-Tomasi corners of the keyframe
  int with_depth = 0;        ///< with a disparity there
  int tracked = 0;           ///< tracked to the current pair, left and right
  int consistent = 0;        ///< left and right agree there: the feature set F
  int rotation_inliers = 0;  ///< left after stage 1
  int translation_inliers =
      0;          ///< left after stage 2; 0 if the criterion or the low speed skips it
  int tries = 0;  ///< how often the features were tracked and a motion estimated
};

/// Wall time of each stage [ms]; several rounds of a stage are added up.
struct StageTimes {
  double pyramids_ms = 0.0;
  double corners_ms = 0.0;
  double disparity_ms = 0.0;
  double tracking_ms = 0.0;
  double estimation_ms = 0.0;
  double total_ms = 0.0;
};

/// What is known of the bias of the disparities.
struct DisparityBias {
  double estimated_px = 0.0;  ///< to be added to every disparity
  double sigma_px = 0.0;      ///< standard deviation of the estimate
  double applied_px = 0.0;    ///< the part of it beyond doubt, which is added
};

/// How far the rows of the right image are below those of the left one that show the same.
/// Rectification should make it nothing; a right camera that is pitched or rolled, or whose lens is
/// not as calibrated, does not.
struct RowOffset {
  double median_px = 0.0;   ///< over the features of the last pairs; 0 before the first
  double sigma_px = 0.0;    ///< standard deviation of the median, features taken as independent
  double typical_px = 0.0;  ///< median of the absolute differences: how far rows are apart
};

/// The answer to one stereo pair.
struct OdometryResult {
  State state = State::kLost;
  std::string reason;         ///< why the state is not ok, in one sentence; empty if it is
  std::int64_t stamp_ns = 0;  ///< of the current pair
  double dt_s = 0.0;          ///< since the previous pair; 0 if there is none
  /// The motion of the left camera since the previous pair: maps points of its current frame to its
  /// previous one. Identity unless the state is ok or degraded. The previous pair is the last one
  /// with a pose: one that was ok, degraded or initialising, or a lost one that this pair matches
  /// while it does not match those before; its pose is taken to be that of the pair before it.
  Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
  /// Covariance of T_prev_cur in axes of the previous camera frame, in the order of REP 103:
  /// translation [m] x y z, then rotation [rad] about x y z, with R = Exp(error) R_estimated and
  /// t = error + t_estimated. Zero unless the state is ok or degraded.
  Matrix6d covariance = Matrix6d::Zero();
  /// The stamp of the pair that the motion was measured against, an earlier one or the previous
  /// one, and the motion since then. Errors add up from keyframe to keyframe, not from pair to
  /// pair.
  std::int64_t keyframe_stamp_ns = 0;
  UncertainTransform T_keyframe_cur;
  DisparityBias disparity_bias;  ///< of the rig, as far as known
  RowOffset row_offset;          ///< likewise; not corrected
  double flow_noise_px = 0.0;    ///< standard deviation in x and y, by the inliers; 0: no motion
  StageCounts counts;
  StageTimes times;

  bool hasMotion() const { return state == State::kOk || state == State::kDegraded; }
};

}  // namespace rotrocc
