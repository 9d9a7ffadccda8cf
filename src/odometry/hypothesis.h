#pragma once

#include "motion/motion_estimator.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// A candidate motion with all data that it was estimated from. It is accepted or discarded as a
/// whole.
struct Hypothesis {
  StereoCamera camera;  ///< corrected by the disparity bias that was used for the features' depths
  Correspondences features;
  MotionEstimator::Estimate estimate;
  StageCounts counts;

  void clear() {
    features.clear();
    estimate.rotation_inliers.clear();
    estimate.translation_inliers.clear();
    counts = {};
  }
};

}  // namespace rotrocc
