#pragma once

#include "motion/motion_estimator.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// A motion that is tried, and all that it is estimated from: taken or dropped as a whole.
struct Hypothesis {
  StereoCamera camera;  ///< with the disparity bias that the features' depths are computed with
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
