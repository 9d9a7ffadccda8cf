#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// State of the odometry after a pair.
enum class State {
  kInitializing,  ///< no earlier pair to compare with
  kOk,
  kDegraded,  ///< a motion was estimated, but is less reliable: see OdometryResult::reason
  kLost       ///< no motion was found, or the pair cannot be used
};

/// "initializing", "ok", "degraded" or "lost".
const char* toString(State state);

/// Number of features left after each stage.
struct StageCounts {
  int corners = 0;           ///< Shi-Tomasi corners of the keyframe that were tried
  int with_depth = 0;        ///< of these, with a disparity: the features
  int tracked = 0;           ///< tracked to both current images
  int consistent = 0;        ///< passed the circular consistency check: the feature set F
  int rotation_inliers = 0;  ///< left after stage 1
  /// Left after stage 2. 0 if it failed or, as published, was skipped.
  int translation_inliers = 0;
  int tries = 0;  ///< number of times the features were tracked and a motion estimated
};

/// Wall time of each stage [ms], summed over all tries, and with what prepare() did for the pair.
struct StageTimes {
  double pyramids_ms = 0.0;
  double corners_ms = 0.0;
  double disparity_ms = 0.0;
  double tracking_ms = 0.0;
  double estimation_ms = 0.0;
  double total_ms = 0.0;     ///< of process()
  double prepared_ms = 0.0;  ///< of prepare() before this pair arrived; not in total_ms
};

/// The estimated bias of the disparities.
struct DisparityBias {
  double estimated_px = 0.0;  ///< correction, to be added to every disparity
  double sigma_px = 0.0;      ///< standard deviation of the estimate
  double applied_px = 0.0;    ///< the significant part of estimated_px, which was added
};

/// Vertical offset of corresponding points: positive if they are lower in the right image. It is
/// zero for a perfectly rectified pair. A right camera that is pitched or rolled, or has a wrong
/// lens calibration, causes an offset.
struct RowOffset {
  double median_px = 0.0;   ///< over the features of the last pairs; 0 before the first pair
  double sigma_px = 0.0;    ///< standard deviation of the median, assuming independent features
  double typical_px = 0.0;  ///< median of the absolute offsets
  /// The offset that was corrected: the right image was read this much lower. Zero if median_px is
  /// not significant.
  double applied_px = 0.0;
};

/// How much later the right images are taken than the left ones, whatever the stamps say.
struct RightDelay {
  double estimated_s = 0.0;
  double sigma_s = 0.0;    ///< standard deviation of the estimate
  double applied_s = 0.0;  ///< the significant part of estimated_s, which was corrected
};

/// The result for one stereo pair.
struct OdometryResult {
  State state = State::kLost;
  std::string reason;         ///< why the state is not ok, in one sentence; empty if it is ok
  std::int64_t stamp_ns = 0;  ///< of the current pair
  /// Stamp of the previous pair, against which T_prev_cur is measured: the last pair that was not
  /// lost; stamp_ns if there is none, or if this pair was rejected before a comparison. A pair that
  /// matches neither it nor the keyframe may match the latest lost pair, which is then the previous
  /// one. The motion before that pair is missing, so the state is degraded.
  std::int64_t prev_stamp_ns = 0;
  /// StereoPair::clock_set_ns of both, and the standard deviation of the current stamp's error.
  std::int64_t clock_set_ns = 0;
  std::int64_t prev_clock_set_ns = 0;
  double stamp_sigma_s = 0.0;
  /// The motion of the left camera since the previous pair: maps points from its current frame to
  /// its previous frame. Identity unless the state is ok or degraded.
  Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
  /// Covariance of T_prev_cur, expressed in the previous camera frame, in the order of REP 103:
  /// translation [m] x y z, then rotation [rad] about x y z. The errors are defined by
  /// R = Exp(error) R_estimated and t = error + t_estimated. It includes systematic errors, see
  /// SystematicErrorConfig. Zero unless the state is ok or degraded.
  Matrix6d covariance = Matrix6d::Zero();
  /// The stamp of the keyframe and the motion since then. The keyframe is the previous pair or an
  /// earlier one. Errors accumulate with each new keyframe, not with each pair. This covariance
  /// contains SystematicErrorConfig's common_share but no errors of scale and axes, because those
  /// do not accumulate like independent ones.
  std::int64_t keyframe_stamp_ns = 0;
  UncertainTransform T_keyframe_cur;
  DisparityBias disparity_bias;  ///< of the rig
  RowOffset row_offset;          ///< of the rig, before the correction
  RightDelay right_delay;        ///< of the rig, before the correction
  /// Contrast of the right image relative to the left one, the median over the matched windows. It
  /// is only reported. 0: no motion.
  double contrast_gain = 0.0;
  /// How often the images were halved before they were used: pixels of soft images show too little.
  /// -1: they were doubled, as windows are too large for so few pixels. Figures in px are of whole
  /// images.
  int halvings = 0;
  /// Side of the smallest detail that may be used, in px of whole images.
  double detail_px() const { return std::exp2(std::max(0, halvings)); }
  double flow_noise_px = 0.0;  ///< standard deviation in x and y, of inliers; 0: no motion
  StageCounts counts;
  StageTimes times;

  /// Time since the previous pair [s]; 0 if nothing was compared.
  double dt_s() const { return 1e-9 * static_cast<double>(time_ns() - prev_time_ns()); }
  /// Times of the current and the previous pair, apart from steps of their clock.
  std::int64_t time_ns() const { return stamp_ns - clock_set_ns; }
  std::int64_t prev_time_ns() const { return prev_stamp_ns - prev_clock_set_ns; }
  bool hasMotion() const { return state == State::kOk || state == State::kDegraded; }
};

}  // namespace rotrocc
