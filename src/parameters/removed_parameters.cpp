#include <algorithm>
#include <iterator>

#include "rotrocc/parameters.h"

namespace rotrocc {
namespace {

constexpr const char* kRemoved[] = {
    "feature_detector/block_radius_px",
    "feature_detector/border_px",
    "feature_detector/cell_size_px",
    "feature_detector/min_response",
    "feature_detector/nms_radius_px",
    "feature_tracker/levels",
    "feature_tracker/max_disparity_difference_px",
    "feature_tracker/max_iterations",
    "feature_tracker/max_vertical_px",
    "feature_tracker/min_step_px",
    "feature_tracker/startup_levels",
    "keyframe_selector/max_parallax_px",
    "keyframe_selector/min_seen_share",
    "motion_check/degraded_depth_share",
    "motion_check/degraded_information_share",
    "motion_check/degraded_relative_sigma",
    "motion_check/degraded_rival_share",
    "motion_check/degraded_rotation_share",
    "motion_check/degraded_start_share",
    "motion_check/degraded_survivor_share",
    "motion_check/degraded_translation_share",
    "motion_estimator/comparison_iterations",
    "motion_estimator/deviation_factor",
    "motion_estimator/mean_factor",
    "motion_estimator/retry_share",
    "motion_estimator/rotation_drop_share",
    "motion_estimator/rotation_max_iterations",
    "motion_estimator/translation_drop_share",
    "motion_estimator/translation_max_iterations",
    "motion_model/max_age_s",
    "stereo_calibrator/flex_px",
    "stereo_calibrator/noise_ratio",
    "stereo_calibrator/prior_sigma_px",
    "stereo_calibrator/robust_factor",
    "stereo_calibrator/shared_error_ratio",
    "stereo_calibrator/significance",
    "stereo_calibrator/steady_pairs",
    "stereo_matcher/max_mean_difference",
    "stereo_matcher/uniqueness",
    "visual_odometry/settled_px",
};

}  // namespace

std::string whyIgnored(const std::string& name) {
  if (std::find(std::begin(kRemoved), std::end(kRemoved), name) == std::end(kRemoved)) return "";
  return "parameter " + name + " no longer exists and is ignored: delete it";
}

}  // namespace rotrocc
