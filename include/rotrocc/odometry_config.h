#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/rigid_motion.h"

namespace rotrocc {

/// Shi-Tomasi corner detection.
struct FeatureDetectorConfig {
  int max_features = 400;    ///< tracked at most: corners without a disparity are replaced
  int wanted_inliers = 240;  ///< fewer features are tracked if so many agree on the motion
  int min_halvings = 0;      ///< of the images, as far as they leave room for the features
};

/// Sparse matching along the row, by normalized correlation.
struct StereoMatcherConfig {
  double nearest_baselines = 3.0;  ///< depth of the nearest points that are found, in baselines
  double min_disparity_px = 1.0;   ///< above the disparity at infinity; farther points are dropped
};

/// Pyramidal Lucas-Kanade.
struct FeatureTrackerConfig {
  int window_radius_px = 4;  ///< the window is a square of side 2 radius + 1
};

/// From images to correspondences.
struct CorrespondenceFinderConfig {
  FeatureDetectorConfig feature_detector;
  StereoMatcherConfig stereo_matcher;
  FeatureTrackerConfig feature_tracker;
};

/// The criteria of the paper that select the features for motion estimation:
///   "rotrocc"       reprojection error for the rotation, then DNRE for the translation (V-B)
///   "reprojection"  stage 1 only
///   "rocc"          as rotrocc, but normalized by the coupled flow (Eq. 8)
///   "mean_based"    one stage, Eq. 32
///   "std_based"     one stage, Eq. 31
const std::vector<std::string>& criterionNames();

struct MotionEstimatorConfig {
  std::string criterion = "rotrocc";  ///< one of criterionNames(); others only as published
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

/// Errors that all features share, so that their scatter does not show them. The defaults are those
/// of KITTI's cars, whose ground truth is exact enough over several pairs.
struct SystematicErrorConfig {
  /// Standard deviation along a translation and of a rotation's angle, relative to their size.
  double scale_share = 0.005;
  double axes_rad = 0.005;  ///< standard deviation of the camera's axes, which turn the motion
  /// Share of the flow noise's variance that is common to all features: adds to the covariance of
  /// the features, see MotionCheck::inflation().
  double common_share = 0.02;

  /// Covariance of errors of scale and axes, in the order of OdometryResult::covariance.
  Matrix6d covarianceOf(const Eigen::Isometry3d& motion) const;
};

/// "default", and "paper", the method as published: PaperFinder, PaperEstimator, and motions from
/// pair to pair. It sets neither max_tries, which is 1 in the paper, nor the self-calibration,
/// which the paper does not have.
const std::vector<std::string>& methodNames();

/// All parameters of the visual odometry, in the order of the data flow.
struct OdometryConfig {
  std::string method = "default";  ///< one of methodNames()
  CorrespondenceFinderConfig correspondence_finder;
  MotionEstimatorConfig motion_estimator;
  MotionCheckConfig motion_check;
  StereoCalibratorConfig stereo_calibrator;
  SystematicErrorConfig systematic_error;

  int max_tries = 8;  ///< maximum number of attempts from each earlier frame

  bool isPaper() const { return method == "paper"; }

  /// Throws std::invalid_argument with the parameter and its value if a name is unknown, or if the
  /// method does not have the criterion.
  void check() const;
};

}  // namespace rotrocc
