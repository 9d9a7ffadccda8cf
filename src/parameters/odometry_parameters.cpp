#include "parameters/sections.h"

namespace rotrocc {
namespace {

void addFeatureDetector(FeatureDetectorConfig& c, ParameterTable& table) {
  table.beginSection("feature_detector");
  table.add("max_features", c.max_features, {50, 20000}).description =
      "number of features: a corner without a disparity is replaced by the next one";
}

void addStereoMatcher(StereoMatcherConfig& c, ParameterTable& table) {
  table.beginSection("stereo_matcher");
  table.add("max_disparity_px", c.max_disparity_px, {8, 2000, "px"}).description =
      "largest disparity; closer points are not matched";
  table.add("min_disparity_px", c.min_disparity_px, {0.1, 100.0, "px"}).description =
      "smallest disparity; points farther away are dropped";
}

void addFeatureTracker(FeatureTrackerConfig& c, ParameterTable& table) {
  table.beginSection("feature_tracker");
  table.add("window_radius_px", c.window_radius_px, {2, 25, "px"}).description =
      "the Lucas-Kanade window is a square of side 2 radius + 1";
  table.add("max_round_trip_px", c.max_round_trip_px, {0.0, 10.0, "px"}).description =
      "largest forward-backward tracking error; 0: not checked, as in the paper";
  table.add("scale_windows", c.scale_windows).description =
      "scale windows by the predicted change of depth; the paper does not";
  table.add("ignore_brightness", c.ignore_brightness).description =
      "estimate changes of brightness and contrast while tracking; the paper does not";
}

void addMotionEstimator(MotionEstimatorConfig& c, ParameterTable& table) {
  table.beginSection("motion_estimator");
  table.add("criterion", c.criterion, criterionNames()).description =
      "criterion that selects the inliers; as published only with config/paper.yaml";
  table.add("noise_ratio", c.noise_ratio, {0.0, 100.0}).description =
      "ratio of disparity noise to flow noise; 0: disparities are exact, as in the paper";
  table.add("shared_ratio", c.shared_ratio, {0.0, 100.0}).description =
      "ratio of the disparity error that neighbours share to flow noise, start of an estimate of "
      "at most three times this; 0: there is none, as in the paper";
  table.add("robust_factor", c.robust_factor, {0.0, 1000.0}).description =
      "residual, in standard deviations, at which the Cauchy weight is 1/2; 0: equal weights, as "
      "in the paper";
  table.add("rotation_limit_px", c.rotation_limit_px, {0.01, 100.0, "px"}).description =
      "stage 1: termination limit of the reprojection error (Eq. 26)";
  table.add("retry_agreement_px", c.retry_agreement_px, {0.0, 1000.0, "px"}).description =
      "stage 1: a retry starts from features with an error below this at the predicted motion; 0: "
      "no retry";
  table.add("translation_limit", c.translation_limit, {0.001, 100.0}).description =
      "stage 2: termination limit of the DNRE (Eq. 30)";
  table.add("translation_noise_factor", c.translation_noise_factor, {0.0, 100.0}).description =
      "stage 2: number of standard deviations of the noise that the limit admits where the flow "
      "is small; 0: none, as in the paper";
  table.add("translation_from_prediction", c.translation_from_prediction).description =
      "stage 2: starts from the predicted translation, as in the paper, not from stage 1's";
  table.add("translation_initial_px", c.translation_initial_px, {0.0, 1000.0, "px"}).description =
      "stage 2: starts from features with a stage-1 error below this; 0: from all";
  table.add("min_speed_mps", c.min_speed_mps, {0.0, 1000.0, "m/s"}).description =
      "stage 2 is skipped below this speed";
}

void addMotionCheck(MotionCheckConfig& c, ParameterTable& table) {
  table.beginSection("motion_check");
  table.add("min_inliers", c.min_inliers, {3, 10000}).description =
      "number of inliers below which the motion is lost: fewer do not determine its noise";
  table.add("min_inlier_share", c.min_inlier_share, {0.0, 1.0}).description =
      "share of inliers below which the motion is lost";
  table.add("max_speed_mps", c.max_speed_mps, {0.1, 1000.0, "m/s"}).description =
      "speed above which the motion is lost";
  table.add("max_turn_rate_rps", c.max_turn_rate_rps, {0.1, 100.0, "rad/s"}).description =
      "turn rate above which the motion is lost";
  table.add("max_acceleration_mps2", c.max_acceleration_mps2, {0.1, 10000.0, "m/s2"}).description =
      "acceleration above which the motion is degraded";
}

void addStereoCalibrator(StereoCalibratorConfig& c, ParameterTable& table) {
  table.beginSection("stereo_calibrator");
  table.add("enabled", c.enabled).description =
      "estimate and correct the disparity bias, and correct the row offset";
  table.add("bias_px", c.bias_px, {-20.0, 20.0, "px"}).description =
      "known correction, added to all disparities; initial value of the estimate";
}

void addKeyframeSelector(KeyframeSelectorConfig& c, ParameterTable& table) {
  table.beginSection("keyframe_selector");
  table.add("adaptive", c.adaptive).description =
      "keep a keyframe while the camera rests; if false, the previous pair is the keyframe";
}

void addSystematicError(SystematicErrorConfig& c, ParameterTable& table) {
  table.beginSection("systematic_error");
  table.add("translation_share", c.translation_share, {0.0, 1.0}).description =
      "standard deviation that calibration and time stamps add to a translation, as a share of "
      "its length";
  table.add("rotation_share", c.rotation_share, {0.0, 1.0}).description =
      "the same for a rotation, as a share of its angle";
}

void addVisualOdometry(OdometryConfig& c, ParameterTable& table) {
  table.beginSection("visual_odometry");
  table.add("threads", c.threads, {1, 16}).description =
      "threads per pair, including the calling one; results do not depend on it";
  table.add("max_tries", c.max_tries, {1, 20}).description =
      "largest number of tries of a pair: each tracks the features and estimates the motion";
  table.add("max_gap_s", c.max_gap_s, {0.01, 1000.0, "s"}).description =
      "the estimator restarts after a longer gap between pairs, and does not predict after half "
      "of it";
}

}  // namespace

void addOdometry(OdometryConfig& config, ParameterTable& table) {
  CorrespondenceFinderConfig& finder = config.correspondence_finder;
  addFeatureDetector(finder.feature_detector, table);
  addStereoMatcher(finder.stereo_matcher, table);
  addFeatureTracker(finder.feature_tracker, table);
  addMotionEstimator(config.motion_estimator, table);
  addMotionCheck(config.motion_check, table);
  addKeyframeSelector(config.keyframe_selector, table);
  addStereoCalibrator(config.stereo_calibrator, table);
  addSystematicError(config.systematic_error, table);
  addVisualOdometry(config, table);
}

}  // namespace rotrocc
