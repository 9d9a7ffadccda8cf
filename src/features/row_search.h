#pragma once

#include <vector>

#include "features/feature_tracker.h"
#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Measures the row offset between the left and the right image at a sample of points. Offsets are
/// positive if a point is lower in the right image. Has no state except reused buffers.
class RowSearch {
 public:
  /// Largest offset at which corners are found, in pixels of detail.
  static constexpr int kMaxRows = 3;

  explicit RowSearch(const CorrespondenceFinderConfig& config);

  /// Offsets [px] of a sample of the keyframe's corners. They may be up to kMaxRows and need not
  /// be known before: several rows are searched.
  std::vector<float> search(const StereoCamera& camera, const Keyframe& keyframe);

  /// Sets `offsets_px` to those of a sample of the flagged features of `current`, near
  /// `row_offset_px`.
  void measure(const StereoCamera& camera,
               const StereoFrame& current,
               const Correspondences& features,
               const FeatureSet& set,
               double row_offset_px,
               std::vector<float>& offsets_px);

 private:
  StereoMatcher matcher_;
  FeatureTracker tracker_;
};

}  // namespace rotrocc
