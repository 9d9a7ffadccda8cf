#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "features/feature_tracker.h"
#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Row offsets of single features, positive if a feature is lower in the right image.
struct RowOffsets {
  std::vector<std::size_t> features;  ///< indices
  std::vector<float> offsets_px;      ///< in the same order
};

/// Measures the row offset between the left and the right image at a sample of points. Offsets are
/// positive if a point is lower in the right image. Has no state except reused buffers.
class RowSearch {
 public:
  explicit RowSearch(const CorrespondenceFinderConfig& config);

  /// Offsets [px] of a sample of the keyframe's corners. They may be up to 3 px and need not be
  /// known before: several rows are searched.
  void search(const StereoCamera& camera, const Keyframe& keyframe, std::vector<float>& offsets_px);

  /// Offsets of a sample of the flagged features of `current`, near `row_offset_px`.
  void measure(const StereoFrame& current,
               const Correspondences& features,
               const FeatureSet& set,
               double row_offset_px,
               RowOffsets& offsets);

 private:
  /// Where a corner was found when several rows were searched. If these are not the same place, its
  /// row is unknown.
  struct Found {
    static constexpr float kSamePlace_px = 1.0F;

    float lowest_px = std::numeric_limits<float>::max();
    float highest_px = std::numeric_limits<float>::lowest();
    float nearest_px = 0.0F;  ///< of the position nearest to where it was searched
    float nearest_distance_px = std::numeric_limits<float>::max();

    /// Adds a position at the offset `offset_px`, found by a search at `searched_px`.
    void add(float offset_px, float searched_px) {
      const float distance_px = std::abs(offset_px - searched_px);
      if (distance_px > kSamePlace_px) return;
      lowest_px = std::min(lowest_px, offset_px);
      highest_px = std::max(highest_px, offset_px);
      if (distance_px >= nearest_distance_px) return;
      nearest_distance_px = distance_px;
      nearest_px = offset_px;
    }

    bool isUnique() const {
      return highest_px >= lowest_px && highest_px - lowest_px <= kSamePlace_px;
    }
  };

  void searchRow(const StereoCamera& camera, const StereoFrame& frame, int rows);

  StereoMatcher matcher_;
  FeatureTracker tracker_;
  Workers workers_;  // the calling thread only: the sample is small

  // Buffers, reused.
  std::vector<cv::Point2f> sample_px_;
  std::vector<float> disparities_px_;
  std::vector<Found> found_;
};

}  // namespace rotrocc
