#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Decides how long a pair stays the reference that motions are measured against. Errors add up
/// with every change of the reference, so that it is kept while it serves: while the camera has not
/// moved far and most features are still seen. At rest nothing adds up at all.
class ReferenceSelector {
 public:
  struct Config {
    bool adaptive = true;          ///< if not, every pair is the next one's reference
    double max_parallax_px = 8.0;  ///< median flow that the translation may make
    double min_seen_share = 0.7;   ///< of the features that the first pair found again
  };

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
