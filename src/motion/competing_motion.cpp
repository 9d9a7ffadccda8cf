#include "motion/competing_motion.h"

#include <cstddef>

#include "motion/consensus_motion.h"
#include "motion/median_depth.h"
#include "motion/outlier_rejection.h"
#include "motion/reprojection_error.h"

namespace rotrocc {
namespace {

/// Features with a larger error contradict a motion. Those that are only inexact have a smaller
/// one.
constexpr double kContradiction_px = 2.0;

/// What is this many times as deep is behind.
constexpr double kBehind = 2.0;

}  // namespace

CompetingMotion::Competitors CompetingMotion::find(const StereoCamera& camera,
                                                   const Correspondences& features,
                                                   const Eigen::Isometry3d& T_keyframe_cur,
                                                   const FeatureSet& inliers,
                                                   int min_count) {
  reprojectionErrors(camera, features, T_keyframe_cur, errors_px_);
  others_.clear();
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (errors_px_[i] > kContradiction_px) others_.push_back(features[i]);
  }
  if (static_cast<int>(others_.size()) < min_count) return {};
  const auto competitor = consensusMotion(camera, others_);
  if (!competitor) return {};
  reprojectionErrors(camera, others_, *competitor, errors_px_);
  agree_.assign(others_.size(), 1);
  keepBelow(errors_px_, kContradiction_px, agree_);
  const int agree = count(agree_);
  if (agree < min_count) return {};
  const double depth_m = medianDepth(others_, agree_, depths_m_);
  return {agree, depth_m > kBehind * medianDepth(features, inliers, depths_m_)};
}

}  // namespace rotrocc
