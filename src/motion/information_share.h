#pragma once

#include <Eigen/Geometry>

#include "motion/fitted_feature.h"
#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// How much of what all features of a pair say about its motion the inliers say.
class InformationShare {
 public:
  /// The smallest share, over all directions of the six-dimensional motion, of the Fisher
  /// information of all features that the inliers have, without the inlier of greatest leverage. In
  /// [0, 1]; 0 if these features do not determine the motion.
  ///
  /// If it is small, the motion depends on one feature, or other features contradict those that
  /// determine it. The inliers fit it nevertheless, and their residuals are as small as usual.
  double minimum(const Measurements& measured,
                 const Eigen::Isometry3d& T_keyframe_cur,
                 const FeatureSet& inliers);

 private:
  Matrix6d informationOf(const StereoCamera& camera, const FeatureSet& set);

  // Buffers, reused.
  Fit fit_;
  FeatureSet all_;
  ReprojectionProblem<6> problem_;
};

}  // namespace rotrocc
