#pragma once

#include <vector>

#include "odometry/hypothesis.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Decides when the keyframe is replaced. Noise accumulates with each new keyframe, so a keyframe
/// is kept while the camera rests: there is no drift at standstill. In motion each frame is the
/// keyframe of the next one, because the errors of a feature grow with the way that it is tracked.
class KeyframeSelector {
 public:
  using Config = KeyframeSelectorConfig;

  explicit KeyframeSelector(const Config& config) : config_(config) {}

  /// Whether to keep the keyframe for the next frame, given the motion of the current frame: the
  /// median inlier has moved by less than kRest times the noise of the flow.
  bool keeps(const Hypothesis& accepted);

  /// The noise of a frame-to-frame motion is a tenth of the motion there.
  static constexpr double kRest = 10.0;

 private:
  Config config_;
  std::vector<double> flow_px_, inlier_flow_px_;  // buffers, reused
};

}  // namespace rotrocc
