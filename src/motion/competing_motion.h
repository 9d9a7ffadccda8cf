#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Finds the features that contradict a motion and agree on another one: those of a large object,
/// or of the scene if the object's motion was found.
class CompetingMotion {
 public:
  struct Competitors {
    int count = 0;            ///< 0: fewer than asked for
    bool are_behind = false;  ///< more than twice as deep as the inliers, by the median
  };

  /// Returns nothing if fewer than `min_count` > 0 features agree on another motion. There must be
  /// inliers.
  Competitors find(const StereoCamera& camera,
                   const Correspondences& features,
                   const Eigen::Isometry3d& T_keyframe_cur,
                   const FeatureSet& inliers,
                   int min_count);

 private:
  // Buffers, reused.
  Correspondences others_;
  FeatureSet agree_;
  std::vector<double> errors_px_, depths_m_;
};

}  // namespace rotrocc
