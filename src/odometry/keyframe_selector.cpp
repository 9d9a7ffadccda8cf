#include "odometry/keyframe_selector.h"

#include "common/median.h"
#include "motion/flow_decoupling.h"
#include "motion/outlier_rejection.h"

namespace rotrocc {

bool KeyframeSelector::keeps(const Hypothesis& accepted, Keyframe& keyframe) {
  if (!config_.adaptive) return false;
  const FeatureSet& inliers = accepted.estimate.rotation_inliers;
  const double seen = static_cast<double>(count(inliers)) / accepted.counts.searched;
  if (keyframe.first_inlier_share == 0.0) keyframe.first_inlier_share = seen;
  if (seen < config_.min_seen_share * keyframe.first_inlier_share) return false;

  decoupledFlow(
      accepted.camera, accepted.features, accepted.estimate.T_keyframe_cur.linear(), flow_px_);
  inlier_flow_px_.clear();
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    if (inliers[i] != 0) inlier_flow_px_.push_back(flow_px_[i]);
  }
  return !inlier_flow_px_.empty() && median(inlier_flow_px_) <= config_.max_parallax_px;
}

}  // namespace rotrocc
