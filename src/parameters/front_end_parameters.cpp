#include "parameters/sections.h"

namespace rotrocc {
namespace {

void addFeatureDetector(FeatureDetectorConfig& c, ParameterTable& table) {
  table.add("feature_detector/max_features",
            c.max_features,
            50,
            20000,
            "",
            "number of features: a corner without a disparity is replaced by the next one");
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
}

void addFeatureTracker(FeatureTrackerConfig& c, ParameterTable& table) {
  const std::string s = "feature_tracker/";
  table.add(s + "window_radius_px",
            c.window_radius_px,
            2,
            25,
            "px",
            "the Lucas-Kanade window is a square of side 2 radius + 1");
  table.add(s + "levels",
            c.levels,
            1,
            8,
            "",
            "pyramid levels, for features that are not near their prediction");
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
            "estimate changes of brightness and contrast while tracking; the paper does not");
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
