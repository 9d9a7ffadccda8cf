#pragma once

#include <optional>
#include <string>

#include "motion/motion_estimator.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// A candidate motion with all data that it was estimated from. It is accepted or discarded as a
/// whole.
struct Hypothesis {
  static constexpr const char* kNotTried = "no try is left";  // short, so without an allocation

  StereoCamera camera;  ///< corrected by the disparity bias that was used for the features' depths
  Correspondences features;
  bool has_prediction = false;  ///< the motion was searched near a prediction
  double shared_ratio = 0.0;    ///< that was used, see Measurements
  double exposure_gain = 1.0;   ///< see OdometryResult
  MotionEstimate estimate;
  StageCounts counts;
  std::optional<std::string> why_lost = kNotTried;  ///< none if the motion is accepted

  bool isAccepted() const { return !why_lost; }

  void clear() {
    features.clear();
    estimate.rotation_inliers.clear();
    estimate.translation_inliers.clear();
    counts = {};
    why_lost = kNotTried;
  }
};

}  // namespace rotrocc
