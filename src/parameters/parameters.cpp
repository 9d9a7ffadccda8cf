#include "rotrocc/parameters.h"

#include "rotrocc/flow_picture.h"

namespace rotrocc {
namespace {

void addFeatureDetector(FeatureDetectorConfig& c, ParameterTable& table) {
  const std::string s = "feature_detector/";
  table.add(s + "max_features", c.max_features, 50, 20000, "", "corners per image");
  table.add(s + "block_radius_px",
            c.block_radius_px,
            1,
            15,
            "px",
            "the corner measure is taken over a square of 2 radius + 1");
  table.add(s + "nms_radius_px", c.nms_radius_px, 1, 50, "px", "no two corners nearer than this");
  table.add(s + "cell_size_px", c.cell_size_px, 8, 1000, "px", "grid that spreads the corners");
  table.add(s + "min_response",
            c.min_response,
            0.0,
            1e6,
            "(grey levels/px)^2",
            "least smaller eigenvalue of a corner");
  table.add(s + "border_px", c.border_px, 1, 200, "px", "no corners this near to the edge");
}

void addStereoMatcher(StereoMatcherConfig& c, ParameterTable& table) {
  const std::string s = "stereo_matcher/";
  table.add(s + "max_disparity_px", c.max_disparity_px, 8, 2000, "px", "nearer points are dropped");
  table.add(
      s + "min_disparity_px", c.min_disparity_px, 0.1, 100.0, "px", "farther points are dropped");
  table.add(s + "max_mean_difference",
            c.max_mean_difference,
            1.0,
            255.0,
            "grey levels",
            "per pixel, of the best match");
  table.add(s + "uniqueness",
            c.uniqueness,
            0.1,
            1.0,
            "",
            "best SAD over the best elsewhere on the row, at most");
}

void addFeatureTracker(FeatureTrackerConfig& c, ParameterTable& table) {
  const std::string s = "feature_tracker/";
  table.add(s + "window_radius_px",
            c.window_radius_px,
            2,
            25,
            "px",
            "the Lucas-Kanade window is a square of 2 radius + 1");
  table.add(s + "levels", c.levels, 1, 8, "", "pyramid levels with a motion prediction");
  table.add(s + "startup_levels", c.startup_levels, 1, 8, "", "pyramid levels without one");
  table.add(s + "max_iterations", c.max_iterations, 1, 100, "", "per pyramid level");
  table.add(s + "min_step_px", c.min_step_px, 0.0001, 1.0, "px", "iterations end below it");
  table.add(s + "max_round_trip_px",
            c.max_round_trip_px,
            0.05,
            10.0,
            "px",
            "tracked forward and back, a feature must return to within this");
  table.add(s + "max_vertical_px",
            c.max_vertical_px,
            0.1,
            20.0,
            "px",
            "row difference of left and right");
  table.add(s + "max_disparity_difference_px",
            c.max_disparity_difference_px,
            0.1,
            20.0,
            "px",
            "between the tracked and the matched disparity");
}

void addMotionEstimator(MotionEstimatorConfig& c, ParameterTable& table) {
  const std::string s = "motion_estimator/";
  table.add(s + "criterion", c.criterion, criterionNames(), "which features are inliers");
  table.add(
      s + "noise_ratio",
      c.noise_ratio,
      0.0,
      100.0,
      "",
      "disparity noise over flow noise to begin with; 0: disparities are exact, as in the paper");
  table.add(
      s + "robust_factor",
      c.robust_factor,
      0.0,
      1000.0,
      "",
      "features this many standard deviations off count half (Cauchy's weights); 0: all count "
      "alike, as in the paper");
  table.add(s + "rotation_limit_px",
            c.rotation_limit_px,
            0.01,
            100.0,
            "px",
            "stage 1: termination limit of the reprojection error (Eq. 26)");
  table.add(s + "rotation_drop_share",
            c.rotation_drop_share,
            0.001,
            1.0,
            "",
            "stage 1: share of the features an iteration drops at most (b of Eq. 26)");
  table.add(s + "rotation_max_iterations", c.rotation_max_iterations, 1, 1000, "", "stage 1");
  table.add(
      s + "retry_share",
      c.retry_share,
      0.0,
      1.0,
      "",
      "stage 1: if fewer of the features agree, it is tried from those near to the prediction");
  table.add(s + "retry_agreement_px",
            c.retry_agreement_px,
            0.0,
            1000.0,
            "px",
            "stage 1: how near that is; 0: never tried");
  table.add(s + "translation_limit",
            c.translation_limit,
            0.001,
            100.0,
            "",
            "stage 2: termination limit of the DNRE (Eq. 30)");
  table.add(s + "translation_drop_share",
            c.translation_drop_share,
            0.001,
            1.0,
            "",
            "stage 2: share of the features an iteration drops at most (b of Eq. 30)");
  table.add(s + "translation_max_iterations", c.translation_max_iterations, 1, 1000, "", "stage 2");
  table.add(s + "translation_initial_px",
            c.translation_initial_px,
            0.0,
            1000.0,
            "px",
            "stage 2 begins with features whose stage-1 error is below; 0: with all");
  table.add(s + "min_flow_px",
            c.min_flow_px,
            0.0,
            100.0,
            "px",
            "least flow a DNRE is normalized with: the noise of the flow");
  table.add(s + "min_speed_mps", c.min_speed_mps, 0.0, 1000.0, "m/s", "stage 2 is skipped below");
  table.add(s + "mean_factor", c.mean_factor, 0.1, 1000.0, "", "mean_based: factor of Eq. 32");
  table.add(
      s + "deviation_factor", c.deviation_factor, 0.1, 1000.0, "", "std_based: factor of Eq. 31");
  table.add(s + "comparison_iterations",
            c.comparison_iterations,
            1,
            1000,
            "",
            "mean_based, std_based: iterations at most");
}

void addMotionModel(MotionModelConfig& c, ParameterTable& table) {
  table.add("motion_model/max_age_s",
            c.max_age_s,
            0.0,
            100.0,
            "s",
            "after a longer gap the last motion predicts nothing");
}

void addMotionCheck(MotionCheckConfig& c, ParameterTable& table) {
  const std::string s = "motion_check/";
  table.add(s + "min_inliers", c.min_inliers, 3, 10000, "", "fewer: lost");
  table.add(
      s + "min_inlier_share", c.min_inlier_share, 0.0, 1.0, "", "of the feature set; less: lost");
  table.add(s + "degraded_inliers", c.degraded_inliers, 3, 10000, "", "fewer: degraded");
  table.add(s + "degraded_inlier_share", c.degraded_inlier_share, 0.0, 1.0, "", "less: degraded");
  table.add(s + "max_speed_mps", c.max_speed_mps, 0.1, 1000.0, "m/s", "faster: lost");
  table.add(s + "max_turn_rate_rps", c.max_turn_rate_rps, 0.1, 100.0, "rad/s", "faster: lost");
  table.add(s + "max_acceleration_mps2",
            c.max_acceleration_mps2,
            0.1,
            10000.0,
            "m/s2",
            "a larger change of the velocity: degraded");
}

void addNoiseEstimator(NoiseEstimatorConfig& c, ParameterTable& table) {
  const std::string s = "noise_estimator/";
  table.add(s + "enabled", c.enabled, "estimate motion_estimator/noise_ratio");
  table.add(s + "max_ratio", c.max_ratio, 0.5, 100.0, "", "at most so much is believed");
  table.add(s + "memory_pairs",
            c.memory_pairs,
            2.0,
            1e6,
            "",
            "the weight of a pair falls by 1/e over as many");
}

void addStereoCalibrator(StereoCalibratorConfig& c, ParameterTable& table) {
  const std::string s = "stereo_calibrator/";
  table.add(s + "enabled", c.enabled, "estimate the bias of all disparities and correct it");
  table.add(s + "bias_px",
            c.bias_px,
            -20.0,
            20.0,
            "px",
            "known bias, added to all disparities; the estimate begins there");
  table.add(s + "prior_sigma_px",
            c.prior_sigma_px,
            0.001,
            100.0,
            "px",
            "how far from bias_px a rig may be expected to be");
  table.add(s + "memory_pairs",
            c.memory_pairs,
            2.0,
            1e6,
            "",
            "the weight of a pair falls by 1/e over as many");
  table.add(s + "significance",
            c.significance,
            0.0,
            100.0,
            "",
            "so many standard deviations are doubt: not corrected; what is beyond twice the doubt "
            "is, in full");
  table.add(s + "matching_sigma_px",
            c.matching_sigma_px,
            0.0,
            10.0,
            "px",
            "what matching may be off by in the whole image alike, part of the uncertainty");
  table.add(s + "noise_ratio",
            c.noise_ratio,
            0.0,
            100.0,
            "",
            "disparity noise over flow noise, weights the residuals");
  table.add(s + "robust_factor",
            c.robust_factor,
            0.0,
            1000.0,
            "",
            "features this many standard deviations off count half; 0: all count alike");
}

void addKeyframeSelector(KeyframeSelectorConfig& c, ParameterTable& table) {
  const std::string s = "keyframe_selector/";
  table.add(s + "adaptive",
            c.adaptive,
            "measure motions against a pair as long as it serves, not always the previous one");
  table.add(s + "max_parallax_px",
            c.max_parallax_px,
            0.0,
            1000.0,
            "px",
            "it serves until the translation's median flow is larger");
  table.add(s + "min_seen_share",
            c.min_seen_share,
            0.0,
            1.0,
            "",
            "it serves until fewer of the features that agreed on the first motion do");
}

void addVisualOdometry(OdometryConfig& c, ParameterTable& table) {
  const std::string s = "visual_odometry/";
  table.add(s + "threads",
            c.threads,
            1,
            16,
            "",
            "that work on a pair, the calling one included; the results are the same");
  table.add(s + "startup_rounds",
            c.startup_rounds,
            1,
            20,
            "",
            "predict, track, estimate this often without a prediction");
  table.add(s + "startup_settled_px",
            c.startup_settled_px,
            0.0,
            100.0,
            "px",
            "fewer rounds if the prediction moved less");
  table.add(s + "max_gap_s", c.max_gap_s, 0.01, 1000.0, "s", "longer between pairs: start anew");
}

void addNode(NodeParameters& n, ParameterTable& table) {
  table.add("odom_frame", n.odom_frame, {}, "frame of the odometry's pose");
  table.add("base_frame", n.base_frame, {}, "frame of the robot; its pose and twist are published");
  table.add("camera_frame",
            n.camera_frame,
            {},
            "frame of the left camera; if empty, the one the images name");
  table.add("publish_tf", n.publish_tf, "broadcast odom_frame -> base_frame");
  table.add("invert_tf", n.invert_tf, "broadcast base_frame -> odom_frame instead");
  table.add("planar", n.planar, "the base moves along its x and y and turns about its z only");
  table.add("guess_frame",
            n.guess_frame,
            {},
            "odom frame of another odometry in tf, taken as prediction; then odom_frame -> "
            "guess_frame is broadcast; none if empty");
  table.add("guess_timeout_s",
            n.guess_timeout_s,
            0.0,
            1.0,
            "s",
            "how long a pair waits for the tf of guess_frame");
  table.add(
      "image_transport", n.image_transport, {}, "transport of both images: raw, compressed, ...");
  table.add("max_stamp_difference_s",
            n.max_stamp_difference_s,
            0.0,
            1.0,
            "s",
            "between the left and the right image of a pair");
  table.add(
      "queue_size", n.queue_size, 1, 100, "", "images that wait for their partner, on each side");
  table.add("max_image_pixels",
            n.max_image_pixels,
            256,
            1000000000,
            "px",
            "width times height of an image; greater ones are dropped");
  table.add("max_future_s",
            n.max_future_s,
            0.0,
            1e9,
            "s",
            "images stamped further ahead of the clock are dropped");
  table.add("baseline_m",
            n.baseline_m,
            0.0,
            100.0,
            "m",
            "between the cameras, if P[3] of camera_info does not tell; 0: it does");
  table.add("pose_after_time_jump",
            n.pose_after_time_jump,
            {"keep", "zero"},
            "the pose when stamps begin anew, as a bag in a loop does");
  table.add("silence_s",
            n.silence_s,
            0.5,
            3600.0,
            "s",
            "without a pair, until the log says what came and what to change");
  table.add("flow_view", n.flow_view, flowViewNames(), "what the flow topic shows");
  table.add("path_length", n.path_length, 0, 1000000, "", "poses the path topic keeps");
  table.add("lost_speed_sigma_mps",
            n.lost_speed_sigma_mps,
            0.0,
            1000.0,
            "m/s",
            "how fast the position gets uncertain while lost");
  table.add("lost_turn_rate_sigma_rps",
            n.lost_turn_rate_sigma_rps,
            0.0,
            100.0,
            "rad/s",
            "how fast the orientation gets uncertain while lost");
  table.add("trajectory_length",
            n.trajectory_length,
            1,
            10000000,
            "",
            "poses kept for the service save_trajectory");
  table.add("trajectory_file",
            n.trajectory_file,
            {},
            "left camera poses are written there; none if empty");
  table.add("trajectory_format", n.trajectory_format, {"tum", "kitti"}, "of trajectory_file");
}

}  // namespace

ParameterTable makeParameterTable(Parameters& parameters) {
  ParameterTable table;
  addNode(parameters.node, table);
  OdometryConfig& odometry = parameters.odometry;
  addFeatureDetector(odometry.correspondence_finder.feature_detector, table);
  addStereoMatcher(odometry.correspondence_finder.stereo_matcher, table);
  addFeatureTracker(odometry.correspondence_finder.feature_tracker, table);
  addMotionModel(odometry.motion_model, table);
  addMotionEstimator(odometry.motion_estimator, table);
  addMotionCheck(odometry.motion_check, table);
  addKeyframeSelector(odometry.keyframe_selector, table);
  addNoiseEstimator(odometry.noise_estimator, table);
  addStereoCalibrator(odometry.stereo_calibrator, table);
  addVisualOdometry(odometry, table);
  return table;
}

}  // namespace rotrocc
