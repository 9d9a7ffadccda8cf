#pragma once

#include <vector>

#include "features/keyframe.h"
#include "odometry/hypothesis.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Decides when the keyframe is replaced. Errors accumulate with each new keyframe, so a keyframe
/// is kept as long as the camera has not moved far from it and most of its features are still seen.
/// At standstill there is no drift at all.
class KeyframeSelector {
 public:
  using Config = KeyframeSelectorConfig;

  explicit KeyframeSelector(const Config& config) : config_(config) {}

  /// Whether to keep the keyframe for the next frame, given the motion of the current frame. Sets
  /// the keyframe's first_inlier_share if it is not set yet.
  bool keeps(const Hypothesis& accepted, Keyframe& keyframe);

 private:
  Config config_;
  std::vector<double> flow_px_, inlier_flow_px_;  // buffers, reused
};

}  // namespace rotrocc
