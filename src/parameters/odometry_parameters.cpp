#include "parameters/sections.h"

namespace rotrocc {
namespace {

void addMotionModel(MotionModelConfig& c, ParameterTable& table) {
  table.add("motion_model/max_age_s",
            c.max_age_s,
            0.0,
            100.0,
            "s",
            "the last motion is not used as prediction after a longer gap");
}

void addMotionCheck(MotionCheckConfig& c, ParameterTable& table) {
  const std::string s = "motion_check/";
  table.add(s + "min_inliers",
            c.min_inliers,
            3,
            10000,
            "",
            "number of inliers below which the motion is lost: fewer do not determine its noise");
  table.add(s + "min_inlier_share",
            c.min_inlier_share,
            0.0,
            1.0,
            "",
            "share of inliers below which the motion is lost");
  table.add(s + "degraded_depth_share",
            c.degraded_depth_share,
            0.0,
            1.0,
            "",
            "share of the keyframe's corners with a disparity, below which the motion is degraded");
  table.add(s + "degraded_rotation_share",
            c.degraded_rotation_share,
            0.0,
            1.0,
            "",
            "share of inliers of the rotation stage below which the motion is degraded");
  table.add(s + "degraded_start_share",
            c.degraded_start_share,
            0.0,
            1.0,
            "",
            "degraded_rotation_share of a motion without a prediction, as after a start");
  table.add(s + "degraded_translation_share",
            c.degraded_translation_share,
            0.0,
            1.0,
            "",
            "share of inliers of the translation stage below which the motion is degraded");
  table.add(s + "degraded_rival_share",
            c.degraded_rival_share,
            0.0,
            1.0,
            "",
            "share of features that agree on another motion, above which the motion is degraded");
  table.add(s + "degraded_survivor_share",
            c.degraded_survivor_share,
            0.0,
            1.0,
            "",
            "share of the keyframe's features with a depth that must be inliers, else degraded");
  table.add(s + "degraded_information_share",
            c.degraded_information_share,
            0.0,
            1.0,
            "",
            "share of the information about each part of the motion that inliers must have without "
            "the most informative one, else degraded");
  table.add(s + "degraded_relative_sigma",
            c.degraded_relative_sigma,
            0.001,
            1000.0,
            "",
            "standard deviation of the translation, relative to its length, above which it is "
            "degraded");
  table.add(s + "max_speed_mps",
            c.max_speed_mps,
            0.1,
            1000.0,
            "m/s",
            "speed above which the motion is lost");
  table.add(s + "max_turn_rate_rps",
            c.max_turn_rate_rps,
            0.1,
            100.0,
            "rad/s",
            "turn rate above which the motion is lost");
  table.add(s + "max_acceleration_mps2",
            c.max_acceleration_mps2,
            0.1,
            10000.0,
            "m/s2",
            "acceleration above which the motion is degraded");
}

void addStereoCalibrator(StereoCalibratorConfig& c, ParameterTable& table) {
  const std::string s = "stereo_calibrator/";
  table.add(s + "enabled",
            c.enabled,
            "estimate and correct the disparity bias, and correct the row offset");
  table.add(s + "bias_px",
            c.bias_px,
            -20.0,
            20.0,
            "px",
            "known correction, added to all disparities; initial value of the estimate");
  table.add(s + "prior_sigma_px",
            c.prior_sigma_px,
            0.001,
            100.0,
            "px",
            "prior standard deviation of the bias around bias_px");
  table.add(
      s + "significance",
      c.significance,
      0.0,
      100.0,
      "",
      "the bias is corrected by half at this number of standard deviations, and hardly below");
  table.add(s + "shared_error_ratio",
            c.shared_error_ratio,
            0.0,
            100.0,
            "",
            "initial ratio of errors that neighbouring features share to the noise of one");
  table.add(s + "steady_pairs",
            c.steady_pairs,
            2.0,
            1e6,
            "",
            "mean number of pairs before a rigid rig begins to move, or the reverse");
  table.add(s + "flex_px",
            c.flex_px,
            0.0,
            100.0,
            "px",
            "standard deviation of the change of the bias from pair to pair while the rig moves");
  table.add(s + "noise_ratio",
            c.noise_ratio,
            0.0,
            100.0,
            "",
            "ratio of disparity noise to flow noise that weights the residuals");
  table.add(
      s + "robust_factor",
      c.robust_factor,
      0.0,
      1000.0,
      "",
      "residual, in standard deviations, at which the Cauchy weight is 1/2; 0: equal weights");
}

void addKeyframeSelector(KeyframeSelectorConfig& c, ParameterTable& table) {
  table.add("keyframe_selector/adaptive",
            c.adaptive,
            "keep a keyframe while the camera rests; if false, the previous pair is the keyframe");
}

void addSystematicError(SystematicErrorConfig& c, ParameterTable& table) {
  const std::string s = "systematic_error/";
  table.add(s + "translation_share",
            c.translation_share,
            0.0,
            1.0,
            "",
            "standard deviation that calibration and time stamps add to a translation, as a share "
            "of its length");
  table.add(s + "rotation_share",
            c.rotation_share,
            0.0,
            1.0,
            "",
            "the same for a rotation, as a share of its angle");
}

void addVisualOdometry(OdometryConfig& c, ParameterTable& table) {
  const std::string s = "visual_odometry/";
  table.add(s + "threads",
            c.threads,
            1,
            16,
            "",
            "threads per pair, including the calling one; results do not depend on it");
  table.add(s + "max_tries",
            c.max_tries,
            1,
            20,
            "",
            "largest number of tries of a pair: each tracks the features and estimates the motion");
  table.add(s + "max_gap_s",
            c.max_gap_s,
            0.01,
            1000.0,
            "s",
            "the estimator restarts after a longer gap between pairs");
}

}  // namespace

void addOdometry(OdometryConfig& config, ParameterTable& table) {
  addFrontEnd(config.correspondence_finder, table);
  addMotionModel(config.motion_model, table);
  addMotionEstimator(config.motion_estimator, table);
  addMotionCheck(config.motion_check, table);
  addKeyframeSelector(config.keyframe_selector, table);
  addStereoCalibrator(config.stereo_calibrator, table);
  addSystematicError(config.systematic_error, table);
  addVisualOdometry(config, table);
}

}  // namespace rotrocc
