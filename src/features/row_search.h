#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "features/feature_tracker.h"
#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The row offset of a feature.
struct RowSample {
  Eigen::Vector2d left_px;  ///< position in the left image
  Eigen::Vector2d flow_px;  ///< its change since the keyframe
  float offset_px;          ///< row in the right image, less that in the left one
};

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

  /// Sets `samples` to a sample of the flagged features of `current`, near `row_offset_px`. Flows
  /// are those by the motion, without the noise of the positions.
  void measure(const StereoCamera& camera,
               const StereoFrame& current,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_keyframe_cur,
               double row_offset_px,
               std::vector<RowSample>& samples);

 private:
  StereoMatcher matcher_;
  FeatureTracker tracker_;
};

}  // namespace rotrocc
