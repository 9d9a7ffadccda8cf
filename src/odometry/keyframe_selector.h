#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "features/keyframe.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Decides how long a keyframe lives. Errors add up with every change of the keyframe, so it is
/// kept while it serves: while the camera has not moved far and most features are still seen. At
/// rest nothing adds up at all.
class KeyframeSelector {
 public:
  using Config = KeyframeSelectorConfig;

  explicit KeyframeSelector(const Config& config) : config_(config) {}

  /// Whether the keyframe serves for the next frame too, from the features of the current one and
  /// the inliers of its motion. Sets the keyframe's first_inliers if it has none yet.
  bool keeps(const StereoCamera& camera,
             const Correspondences& features,
             const FeatureSet& inliers,
             const Eigen::Isometry3d& T_keyframe_cur,
             Keyframe& keyframe);

 private:
  Config config_;
  std::vector<double> flow_px_, inlier_flow_px_;  // reused
};

}  // namespace rotrocc
