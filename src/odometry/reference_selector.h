#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Decides how long a pair stays the reference that motions are measured against. Errors add up
/// with every change of the reference, so that it is kept while it serves: while the camera has not
/// moved far and most features are still seen. At rest nothing adds up at all.
class ReferenceSelector {
 public:
  using Config = KeyframeSelectorConfig;

  explicit ReferenceSelector(const Config& config) : config_(config) {}

  /// A new pair is the reference.
  void restart() { seen_at_first_ = 0; }

  /// Whether the reference serves for the next pair too, from the features of the current one and
  /// those of them that agree with its motion.
  bool keeps(const StereoCamera& camera,
             const Correspondences& features,
             const FeatureSet& inliers,
             const Eigen::Isometry3d& T_ref_cur);

 private:
  Config config_;
  int seen_at_first_ = 0;  // inliers of the first pair after the reference; 0 before it
  std::vector<double> flow_px_, inlier_flow_px_;
};

}  // namespace rotrocc
