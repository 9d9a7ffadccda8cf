#include "odometry/keyframe_selector.h"

#include "common/median.h"
#include "motion/flow_decoupling.h"
#include "motion/outlier_rejection.h"

namespace rotrocc {

bool KeyframeSelector::keeps(const StereoCamera& camera,
                             const Correspondences& features,
                             const FeatureSet& inliers,
                             const Eigen::Isometry3d& T_keyframe_cur,
                             Keyframe& keyframe) {
  if (!config_.adaptive) return false;
  const int seen = count(inliers);
  if (keyframe.first_inliers == 0) keyframe.first_inliers = seen;
  if (seen < config_.min_seen_share * keyframe.first_inliers) return false;

  decoupledFlow(camera, features, T_keyframe_cur.linear(), flow_px_);
  inlier_flow_px_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (inliers[i] != 0) inlier_flow_px_.push_back(flow_px_[i]);
  }
  return !inlier_flow_px_.empty() && median(inlier_flow_px_) <= config_.max_parallax_px;
}

}  // namespace rotrocc
