#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Decides how long a pair stays the keyframe that motions are measured against. Errors add up
/// with every change of the keyframe, so that it is kept while it serves: while the camera has not
/// moved far and most features are still seen. At rest nothing adds up at all.
class KeyframeSelector {
 public:
  using Config = KeyframeSelectorConfig;

  explicit KeyframeSelector(const Config& config) : config_(config) {}

  /// A new pair is the keyframe.
  void restart() { seen_at_first_ = 0; }

  /// Whether the keyframe serves for the next pair too, from the features of the current one and
  /// those of them that agree with its motion.
  bool keeps(const StereoCamera& camera,
             const Correspondences& features,
             const FeatureSet& inliers,
             const Eigen::Isometry3d& T_keyframe_cur);

 private:
  Config config_;
  int seen_at_first_ = 0;  // inliers of the first pair after the keyframe; 0 before it
  std::vector<double> flow_px_, inlier_flow_px_;
};

}  // namespace rotrocc
