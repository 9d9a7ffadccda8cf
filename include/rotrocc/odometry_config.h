#pragma once

#include <string>
#include <vector>

namespace rotrocc {

/// Shi-Tomasi corners.
struct FeatureDetectorConfig {
  int max_features = 2000;
  int block_radius_px = 2;    ///< the gradients are summed over a square of 2 radius + 1
  int nms_radius_px = 4;      ///< no stronger corner this near, in x and y
  int cell_size_px = 32;      ///< side of a grid cell
  double min_response = 2.0;  ///< least smaller eigenvalue: (grey levels / px)^2
  int border_px = 8;          ///< no corners this near to the image's edge
};

/// Sparse block matching along the row.
struct StereoMatcherConfig {
  int max_disparity_px = 128;         ///< above that of infinity; nearer points are not found
  double min_disparity_px = 1.0;      ///< above that of infinity; farther points are dropped
  double max_mean_difference = 20.0;  ///< of the best match, grey levels per pixel
  double uniqueness = 0.92;  ///< best SAD below this times the best one elsewhere on the row
};

/// Pyramidal Lucas-Kanade, and the circular consistency check.
struct FeatureTrackerConfig {
  int window_radius_px = 5;                  ///< the window is a square of 2 radius + 1
  int levels = 2;                            ///< pyramid levels when there is a prediction
  int startup_levels = 5;                    ///< when there is none
  int max_iterations = 10;                   ///< per level
  double min_step_px = 0.02;                 ///< iterations end when a step is shorter
  double max_round_trip_px = 0.5;            ///< forward and backward must meet; 0: not checked
  bool scale_windows = true;                 ///< by the predicted change of depth
  bool ignore_brightness = true;             ///< windows are compared without their mean
  double max_vertical_px = 1.0;              ///< left and right must be on the same row
  double max_disparity_difference_px = 1.0;  ///< of tracked and matched disparity at t
};

/// From images to correspondences.
struct CorrespondenceFinderConfig {
  FeatureDetectorConfig feature_detector;
  StereoMatcherConfig stereo_matcher;
  FeatureTrackerConfig feature_tracker;
};

/// Constant turn rate and velocity.
struct MotionModelConfig {
  double max_age_s = 0.5;  ///< an older motion predicts nothing
};

/// Which features may estimate the motion: "rotrocc", the reprojection error for the rotation, then
/// the DNRE for the translation (section V-B); "reprojection", stage 1 alone; "rocc", like rotrocc
/// but normalized by the coupled flow (Eq. 8); "mean_based", one stage, Eq. 32; "std_based", one
/// stage, Eq. 31.
const std::vector<std::string>& criterionNames();

/// The two-stage estimator.
struct MotionEstimatorConfig {
  std::string criterion = "rotrocc";  ///< one of criterionNames()
  /// Disparity noise over flow noise, see fitted_feature.h; 0: the paper's
  double noise_ratio = 3.0;
  double robust_factor = 2.0;  ///< of CauchyWeights, once a stage has its set; 0: the paper's

  // Stage 1: rotation.
  double rotation_limit_px = 0.6;     ///< termination limit of the reprojection error, Eq. 26
  double rotation_drop_share = 0.15;  ///< of the set, dropped at most by an iteration: b of Eq. 26
  int rotation_max_iterations = 30;
  double retry_share =
      0.6;  ///< of the set left by stage 1; less, and it is tried once more with ...
  double retry_agreement_px = 2.0;  ///< ... just the features this near to the prediction; 0: never

  // Stage 2: translation.
  double translation_limit = 0.05;       ///< termination limit of the DNRE, Eq. 30
  double translation_drop_share = 0.15;  ///< b of Eq. 30
  int translation_max_iterations = 30;
  bool translation_from_prediction = false;  ///< stage 2 starts there, not at stage 1's result
  double translation_initial_px = 1.5;  ///< stage-1 error below which a feature enters; 0: all do
  double min_speed_mps = 1.0;           ///< below it stage 2 is skipped

  // The comparison criteria.
  double mean_factor = 9.0;       ///< of Eq. 32
  double deviation_factor = 1.5;  ///< of Eq. 31
  int comparison_iterations = 10;
};

/// Whether an estimated motion can be believed.
struct MotionCheckConfig {
  int min_inliers = 25;                 ///< fewer: lost
  double min_inlier_share = 0.15;       ///< of the feature set; less: lost
  int degraded_inliers = 80;            ///< fewer: degraded
  double degraded_inlier_share = 0.35;  ///< of the feature set; less: degraded
  double max_speed_mps = 70.0;          ///< faster: lost
  double max_turn_rate_rps = 6.0;       ///< faster: lost
  double max_acceleration_mps2 = 30.0;  ///< a larger change of the velocity: degraded
};

/// How long a keyframe lives.
struct KeyframeSelectorConfig {
  bool adaptive = true;          ///< if not, every frame is the next one's keyframe
  double max_parallax_px = 8.0;  ///< median flow that the translation may make
  double min_seen_share = 0.7;   ///< of the inliers of the keyframe's first motion
};

/// Self-calibration of the disparity bias.
struct StereoCalibratorConfig {
  bool enabled = true;   ///< if not, bias_px is all that is applied
  double bias_px = 0.0;  ///< known already, added to every disparity; the estimate begins there
  double prior_sigma_px = 1.0;  ///< how far from bias_px a rig may be expected to be
  double memory_pairs = 100.0;  ///< a pair's weight falls by 1/e over as many that tell as much
  double significance = 3.0;    ///< standard deviations that count as doubt
  /// What matching may be off by in the whole image alike, which no comparison within it shows:
  /// windows at edges see what is nearer, too. Part of the uncertainty.
  double matching_sigma_px = 0.01;
  /// Disparity noise over flow noise, see fitted_feature.h. Less than what is measured: fitted
  /// disparities also follow errors that neighbours share, and take the estimate with them.
  double noise_ratio = 0.5;
  double robust_factor = 2.0;  ///< of CauchyWeights; 0: all residuals count alike
};

/// All parameters of the visual odometry, in the order of the data flow.
struct OdometryConfig {
  CorrespondenceFinderConfig correspondence_finder;
  MotionModelConfig motion_model;
  MotionEstimatorConfig motion_estimator;
  MotionCheckConfig motion_check;
  KeyframeSelectorConfig keyframe_selector;
  StereoCalibratorConfig stereo_calibrator;

  int threads = 2;                  ///< that work on a pair, the calling one included
  int startup_rounds = 4;           ///< tries of a pair at most: predict, track, estimate
  double startup_settled_px = 0.5;  ///< fewer rounds if the prediction moves less
  double max_gap_s = 1.0;           ///< between two pairs; longer: the estimator restarts
};

}  // namespace rotrocc
