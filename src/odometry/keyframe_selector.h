#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "features/keyframe.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Decides when the keyframe is replaced. Errors accumulate with each new keyframe, so a keyframe
/// is kept as long as the camera has not moved far from it and most of its features are still seen.
/// At standstill there is no drift at all.
class KeyframeSelector {
 public:
  using Config = KeyframeSelectorConfig;

  explicit KeyframeSelector(const Config& config) : config_(config) {}

  /// Whether to keep the keyframe for the next frame, given the features of the current frame and
  /// the inliers of its motion. Sets the keyframe's first_inliers if it is not set yet.
  bool keeps(const StereoCamera& camera,
             const Correspondences& features,
             const FeatureSet& inliers,
             const Eigen::Isometry3d& T_keyframe_cur,
             Keyframe& keyframe);

 private:
  Config config_;
  std::vector<double> flow_px_, inlier_flow_px_;  // buffers, reused
};

}  // namespace rotrocc
