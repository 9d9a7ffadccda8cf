#include "odometry/keyframe_selector.h"

#include <cstddef>

#include "common/median.h"
#include "motion/reprojection_error.h"

namespace rotrocc {

bool KeyframeSelector::keeps(const Hypothesis& accepted) {
  if (!config_.adaptive) return false;
  const FeatureSet& inliers = accepted.estimate.rotation_inliers;
  coupledFlow(accepted.features, flow_px_);
  inlier_flow_px_.clear();
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    if (inliers[i] != 0) inlier_flow_px_.push_back(flow_px_[i]);
  }
  return !inlier_flow_px_.empty() &&
         median(inlier_flow_px_) <= kRest * accepted.estimate.flow_noise_px;
}

}  // namespace rotrocc
