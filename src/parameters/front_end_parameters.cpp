#include "parameters/sections.h"

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
            "compare windows without their brightness and contrast; the paper does not");
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

}  // namespace

void addFrontEnd(CorrespondenceFinderConfig& config, ParameterTable& table) {
  addFeatureDetector(config.feature_detector, table);
  addStereoMatcher(config.stereo_matcher, table);
  addFeatureTracker(config.feature_tracker, table);
}

}  // namespace rotrocc
