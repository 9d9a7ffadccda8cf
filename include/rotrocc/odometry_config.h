#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// Shi-Tomasi corner detection.
struct FeatureDetectorConfig {
  int max_features = 600;  ///< that are tracked: a corner without a disparity is replaced
};

/// Sparse matching along the row, by normalized correlation.
struct StereoMatcherConfig {
  double nearest_baselines = 3.0;  ///< depth of the nearest points that are found, in baselines
  double min_disparity_px = 1.0;   ///< above the disparity at infinity; farther points are dropped
};

/// Pyramidal Lucas-Kanade.
struct FeatureTrackerConfig {
  int window_radius_px = 4;        ///< the window is a square of side 2 radius + 1
  double max_round_trip_px = 1.0;  ///< tolerance of forward-backward tracking; 0: not checked
  bool scale_windows = true;       ///< scale the windows by the predicted scale change
  bool ignore_brightness = true;   ///< estimate a change of brightness and contrast of windows
};

/// From images to correspondences.
struct CorrespondenceFinderConfig {
  FeatureDetectorConfig feature_detector;
  StereoMatcherConfig stereo_matcher;
  FeatureTrackerConfig feature_tracker;
};

/// The criteria that select the features for motion estimation:
///   "rotrocc"       reprojection error for the rotation, then DNRE for the translation (V-B)
///   "reprojection"  stage 1 only
///   "rocc"          as rotrocc, but normalized by the coupled flow (Eq. 8)
///   "mean_based"    one stage, Eq. 32
///   "std_based"     one stage, Eq. 31
const std::vector<std::string>& criterionNames();

/// The two-stage estimator.
struct MotionEstimatorConfig {
  std::string criterion = "rotrocc";  ///< one of criterionNames()
  /// Ratio of disparity noise to flow noise, see fitted_feature.h. 0: the paper's least squares.
  double noise_ratio = 4.0;
  /// Ratio of the disparity error that the features of an image cell share to flow noise: start of
  /// an estimate of at most three times this. 0: they share none, and none is estimated.
  double shared_ratio = 2.0;
  /// Of cauchyWeights(), used once the set of a stage is stable. 0: equal weights.
  double robust_factor = 1.5;
  /// If stage 1 leaves few of the features, it is retried with only those whose error is below this
  /// at the motion that most agree on, and at the prediction. 0: no retry.
  double retry_agreement_px = 2.0;
  /// Errors of this many standard deviations of the flow pass stage 2 even if the flow is small.
  double translation_noise_factor = 2.0;
  /// Stage 2 starts at the prediction, not at the result of stage 1.
  bool translation_from_prediction = false;
  /// Features with a smaller error after stage 1 enter stage 2. 0: all features do.
  double translation_initial_px = 1.5;
};

/// Plausibility limits of an estimated motion.
struct MotionCheckConfig {
  double max_speed_mps = 70.0;     ///< faster: lost
  double max_turn_rate_rps = 6.0;  ///< faster: lost
};

/// Online rig calibration: estimation of the disparity bias.
struct StereoCalibratorConfig {
  bool enabled = true;   ///< false: only bias_px is applied, and no row offset
  double bias_px = 0.0;  ///< known bias, added to every disparity; start of the estimate
};

/// Errors that all features share, so that their scatter does not show them: standard deviations in
/// proportion to the motion. The defaults are those of a drone with ground truth (EuRoC).
struct SystematicErrorConfig {
  double translation_share = 0.015;  ///< of the length of a motion
  double rotation_share = 0.01;      ///< of the angle of a motion

  /// In the order of OdometryResult::covariance: the same in all directions.
  Matrix6d covarianceOf(const Eigen::Isometry3d& motion) const;
};

/// "default", and "paper", the method as published.
const std::vector<std::string>& methodNames();

/// All parameters of the visual odometry, in the order of the data flow.
struct OdometryConfig {
  std::string method = "default";  ///< one of methodNames(); "paper": see useMethodOfPaper()
  CorrespondenceFinderConfig correspondence_finder;
  MotionEstimatorConfig motion_estimator;
  MotionCheckConfig motion_check;
  StereoCalibratorConfig stereo_calibrator;
  SystematicErrorConfig systematic_error;

  int threads = 2;            ///< that process a pair, including the calling thread
  bool keep_keyframe = true;  ///< while stationary; false: each frame is the next one's keyframe
  int max_tries = 8;          ///< most tries (start, track, estimate) from each earlier frame
  /// Between two pairs: if longer, the estimator restarts. After half of it, the last motion does
  /// not predict the next one.
  double max_gap_s = 1.0;

  /// Throws std::invalid_argument with the parameter and its value if a name is unknown.
  void check() const;
};

/// Sets what the paper does otherwise. Neither max_tries, which is 1 in the paper, nor the
/// self-calibration, which it has not.
void useMethodOfPaper(OdometryConfig& config);

}  // namespace rotrocc
