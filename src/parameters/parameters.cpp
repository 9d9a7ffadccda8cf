#include "rotrocc/parameters.h"

#include "rotrocc/flow_picture.h"

namespace rotrocc {
namespace {

void addFeatureDetector(FeatureDetectorConfig& c, ParameterTable& table) {
  const std::string s = "feature_detector/";
  table.add(
      s + "max_features", c.max_features, 50, 20000, "", "largest number of corners per image");
  table.add(s + "block_radius_px",
            c.block_radius_px,
            1,
            15,
            "px",
            "gradients are summed over a square of side 2 radius + 1");
  table.add(s + "nms_radius_px",
            c.nms_radius_px,
            1,
            50,
            "px",
            "smallest distance between two corners, in x or y");
  table.add(s + "cell_size_px",
            c.cell_size_px,
            8,
            1000,
            "px",
            "cell size of the grid that spreads the corners");
  table.add(s + "min_response",
            c.min_response,
            0.0,
            1e6,
            "(grey levels/px)^2",
            "threshold of the Shi-Tomasi response (smaller eigenvalue)");
  table.add(s + "border_px", c.border_px, 1, 200, "px", "border of the image without corners");
}

void addStereoMatcher(StereoMatcherConfig& c, ParameterTable& table) {
  const std::string s = "stereo_matcher/";
  table.add(s + "max_disparity_px",
            c.max_disparity_px,
            8,
            2000,
            "px",
            "largest disparity; closer points are not matched");
  table.add(s + "min_disparity_px",
            c.min_disparity_px,
            0.1,
            100.0,
            "px",
            "smallest disparity; points farther away are dropped");
  table.add(s + "max_mean_difference",
            c.max_mean_difference,
            1.0,
            255.0,
            "grey levels",
            "largest mean difference per pixel of a match");
  table.add(s + "uniqueness",
            c.uniqueness,
            0.1,
            1.0,
            "",
            "largest ratio of the best SAD to the best SAD elsewhere on the row");
}

void addFeatureTracker(FeatureTrackerConfig& c, ParameterTable& table) {
  const std::string s = "feature_tracker/";
  table.add(s + "window_radius_px",
            c.window_radius_px,
            2,
            25,
            "px",
            "the Lucas-Kanade window is a square of side 2 radius + 1");
  table.add(s + "levels", c.levels, 1, 8, "", "pyramid levels if the motion is predicted");
  table.add(
      s + "startup_levels", c.startup_levels, 1, 8, "", "pyramid levels without a prediction");
  table.add(s + "max_iterations",
            c.max_iterations,
            1,
            100,
            "",
            "largest number of iterations per pyramid level");
  table.add(
      s + "min_step_px", c.min_step_px, 0.0001, 1.0, "px", "iterations end when a step is shorter");
  table.add(s + "max_round_trip_px",
            c.max_round_trip_px,
            0.0,
            10.0,
            "px",
            "largest forward-backward tracking error; 0: not checked, as in the paper");
  table.add(s + "scale_windows",
            c.scale_windows,
            "scale windows by the predicted change of depth; the paper does not");
  table.add(s + "ignore_brightness",
            c.ignore_brightness,
            "compare windows without their mean brightness; the paper does not");
  table.add(s + "max_vertical_px",
            c.max_vertical_px,
            0.1,
            20.0,
            "px",
            "largest row difference between left and right");
  table.add(s + "max_disparity_difference_px",
            c.max_disparity_difference_px,
            0.1,
            20.0,
            "px",
            "largest difference between tracked and matched disparity");
}

void addMotionEstimator(MotionEstimatorConfig& c, ParameterTable& table) {
  const std::string s = "motion_estimator/";
  table.add(s + "criterion",
            c.criterion,
            criterionNames(),
            "criterion that selects the inliers; as published only with config/paper.yaml");
  table.add(s + "noise_ratio",
            c.noise_ratio,
            0.0,
            100.0,
            "",
            "ratio of disparity noise to flow noise; 0: disparities are exact, as in the paper");
  table.add(s + "robust_factor",
            c.robust_factor,
            0.0,
            1000.0,
            "",
            "residual, in standard deviations, at which the Cauchy weight is 1/2; 0: equal "
            "weights, as in the paper");
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
            "stage 1: largest share of features dropped per iteration (b of Eq. 26)");
  table.add(s + "rotation_max_iterations",
            c.rotation_max_iterations,
            1,
            1000,
            "",
            "stage 1: largest number of iterations");
  table.add(s + "retry_share",
            c.retry_share,
            0.0,
            1.0,
            "",
            "stage 1: retry if the share of inliers is below this");
  table.add(s + "retry_agreement_px",
            c.retry_agreement_px,
            0.0,
            1000.0,
            "px",
            "stage 1: a retry starts from features with an error below this at the predicted "
            "motion; 0: no retry");
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
            "stage 2: largest share of features dropped per iteration (b of Eq. 30)");
  table.add(s + "translation_max_iterations",
            c.translation_max_iterations,
            1,
            1000,
            "",
            "stage 2: largest number of iterations");
  table.add(s + "translation_from_prediction",
            c.translation_from_prediction,
            "stage 2: starts from the predicted translation, as in the paper, not from stage 1's");
  table.add(s + "translation_initial_px",
            c.translation_initial_px,
            0.0,
            1000.0,
            "px",
            "stage 2: starts from features with a stage-1 error below this; 0: from all");
  table.add(s + "min_speed_mps",
            c.min_speed_mps,
            0.0,
            1000.0,
            "m/s",
            "stage 2 is skipped below this speed");
  table.add(
      s + "mean_factor", c.mean_factor, 0.1, 1000.0, "", "criterion mean_based: factor of Eq. 32");
  table.add(s + "deviation_factor",
            c.deviation_factor,
            0.1,
            1000.0,
            "",
            "criterion std_based: factor of Eq. 31");
  table.add(s + "comparison_iterations",
            c.comparison_iterations,
            1,
            1000,
            "",
            "criteria mean_based and std_based: largest number of iterations");
}

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
            "number of inliers below which the motion is lost");
  table.add(s + "min_inlier_share",
            c.min_inlier_share,
            0.0,
            1.0,
            "",
            "share of inliers below which the motion is lost");
  table.add(s + "degraded_inliers",
            c.degraded_inliers,
            3,
            10000,
            "",
            "number of inliers below which the motion is degraded");
  table.add(s + "degraded_inlier_share",
            c.degraded_inlier_share,
            0.0,
            1.0,
            "",
            "share of inliers below which the motion is degraded");
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
  table.add(s + "enabled", c.enabled, "estimate and correct the disparity bias");
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
  table.add(s + "memory_pairs",
            c.memory_pairs,
            2.0,
            1e6,
            "",
            "the weight of a pair decays by 1/e over this number of pairs");
  table.add(s + "significance",
            c.significance,
            0.0,
            100.0,
            "",
            "the bias is not corrected below this number of standard deviations, and fully "
            "corrected above twice this number");
  table.add(s + "matching_sigma_px",
            c.matching_sigma_px,
            0.0,
            10.0,
            "px",
            "systematic matching error over the whole image, part of the uncertainty");
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
  const std::string s = "keyframe_selector/";
  table.add(s + "adaptive",
            c.adaptive,
            "keep a keyframe over several pairs; if false, the previous pair is the keyframe");
  table.add(s + "max_parallax_px",
            c.max_parallax_px,
            0.0,
            1000.0,
            "px",
            "a new keyframe is selected if the median flow of the translation is larger");
  table.add(
      s + "min_seen_share",
      c.min_seen_share,
      0.0,
      1.0,
      "",
      "a new keyframe is selected if a smaller share of the keyframe's first inliers is left");
}

void addVisualOdometry(OdometryConfig& c, ParameterTable& table) {
  const std::string s = "visual_odometry/";
  table.add(s + "threads",
            c.threads,
            1,
            16,
            "",
            "threads per pair, including the calling one; results do not depend on it");
  table.add(s + "startup_rounds",
            c.startup_rounds,
            1,
            20,
            "",
            "largest number of tries of a pair: each tracks the features and estimates the motion");
  table.add(s + "startup_settled_px",
            c.startup_settled_px,
            0.0,
            100.0,
            "px",
            "rounds end when the predicted positions change by less");
  table.add(s + "max_gap_s",
            c.max_gap_s,
            0.01,
            1000.0,
            "s",
            "the estimator restarts after a longer gap between pairs");
}

void addNode(NodeParameters& n, ParameterTable& table) {
  table.add("odom_frame", n.odom_frame, {}, "frame of the published pose");
  table.add("base_frame", n.base_frame, {}, "robot frame whose pose and twist are published");
  table.add("camera_frame",
            n.camera_frame,
            {},
            "frame of the left camera; if empty, frame_id of the left images");
  table.add("publish_tf", n.publish_tf, "broadcast odom_frame -> base_frame");
  table.add("invert_tf", n.invert_tf, "broadcast base_frame -> odom_frame instead");
  table.add("planar", n.planar, "restrict the motion of base_frame to x, y and yaw");
  table.add("guess_frame",
            n.guess_frame,
            {},
            "odom frame of another odometry in tf, used as motion prediction; odom_frame -> "
            "guess_frame is then broadcast; none if empty");
  table.add("guess_timeout_s",
            n.guess_timeout_s,
            0.0,
            1.0,
            "s",
            "how long a pair waits for the transform from guess_frame");
  table.add(
      "image_transport", n.image_transport, {}, "transport of both images: raw, compressed, ...");
  table.add("max_stamp_difference_s",
            n.max_stamp_difference_s,
            0.0,
            1.0,
            "s",
            "largest stamp difference between the left and the right image of a pair");
  table.add("queue_size", n.queue_size, 1, 100, "", "unmatched images kept per side");
  table.add("max_image_pixels",
            n.max_image_pixels,
            256,
            1000000000,
            "px",
            "largest number of pixels of an image; larger images are dropped");
  table.add("max_future_s",
            n.max_future_s,
            0.0,
            1e9,
            "s",
            "images with stamps further ahead of the clock are dropped");
  table.add("baseline_m",
            n.baseline_m,
            0.0,
            100.0,
            "m",
            "baseline, if camera_info has none in P[3]; 0: use P[3]");
  table.add("pose_after_time_jump",
            n.pose_after_time_jump,
            {"keep", "zero"},
            "pose after time jumps back, e.g. with a looping bag");
  table.add("silence_s",
            n.silence_s,
            0.5,
            3600.0,
            "s",
            "time without a stereo pair until the log reports the received input and a remedy");
  table.add("flow_view", n.flow_view, flowViewNames(), "contents of the flow topic");
  table.add("path_length", n.path_length, 0, 1000000, "", "number of poses in the path topic");
  table.add("lost_speed_sigma_mps",
            n.lost_speed_sigma_mps,
            0.0,
            1000.0,
            "m/s",
            "assumed standard deviation of the speed while lost");
  table.add("lost_turn_rate_sigma_rps",
            n.lost_turn_rate_sigma_rps,
            0.0,
            100.0,
            "rad/s",
            "assumed standard deviation of the turn rate while lost");
  table.add("trajectory_length",
            n.trajectory_length,
            1,
            10000000,
            "",
            "number of poses kept for the service save_trajectory");
  table.add("trajectory_file",
            n.trajectory_file,
            {},
            "file for the poses of the left camera; none if empty");
  table.add(
      "trajectory_format", n.trajectory_format, {"tum", "kitti"}, "format of trajectory_file");
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
  addStereoCalibrator(odometry.stereo_calibrator, table);
  addVisualOdometry(odometry, table);
  return table;
}

}  // namespace rotrocc
