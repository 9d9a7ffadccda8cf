#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What the features of a pair say for and against a motion. Has no state except reused buffers.
class MotionEvidence {
 public:
  /// Features that contradict a motion and agree on another one: those of a large object, or of the
  /// scene if the object's motion was found.
  struct Competitors {
    int count = 0;            ///< 0: fewer than asked for
    bool are_behind = false;  ///< more than twice as deep as the inliers, by the median
  };

  /// Returns nothing if fewer than `min_count` > 0 features agree on another motion. There must be
  /// inliers.
  Competitors competitors(const StereoCamera& camera,
                          const Correspondences& features,
                          const Eigen::Isometry3d& T_keyframe_cur,
                          const FeatureSet& inliers,
                          int min_count);

  /// The smallest share, over all directions of the six-dimensional motion, of the Fisher
  /// information of all features that the inliers have, without the inlier of greatest leverage. In
  /// [0, 1]; 0 if these features do not determine the motion.
  ///
  /// If it is small, the motion depends on one feature, or other features contradict those that
  /// determine it. The inliers fit it nevertheless, and their residuals are as small as usual.
  double informationShare(const Measurements& measured,
                          const Eigen::Isometry3d& T_keyframe_cur,
                          const FeatureSet& inliers);

  /// The median depth [m] of the features of a set that is not empty, in the current frame.
  double medianDepth(const Correspondences& features, const FeatureSet& set);

 private:
  Correspondences others_;
  FeatureSet set_;
  std::vector<double> errors_px_, depths_m_;
  Fit fit_;
  ReprojectionProblem<6> problem_;
};

}  // namespace rotrocc
