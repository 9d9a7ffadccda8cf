#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "features/image_pyramid.h"
#include "features/tracking_window.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Pyramidal Lucas-Kanade (Bouguet 2001), starting at a predicted position and verified by tracking
/// back.
class FeatureTracker {
 public:
  using Config = FeatureTrackerConfig;

  /// Images of a pyramid. In the smallest one, a window reaches four times as far, for features
  /// whose prediction is far off. What is farther is left to the search for the motion.
  static constexpr int kLevels = 3;

  explicit FeatureTracker(const Config& config);

  /// Builds a pyramid of kLevels, or fewer for a small image. Reuses the memory of `pyramid`.
  void makePyramid(const cv::Mat& image, ImagePyramid& pyramid) const;

  /// Tracks the points `keyframe_px` from one image to another. `scales` are the expected scale
  /// changes of the points' windows, above 1 if a point comes nearer. `cur` contains the
  /// predictions and receives the results. `tracked` becomes 1 for points that are found, otherwise
  /// 0. Points with `tracked` = 0 on input are skipped. The smaller images of the pyramids are used
  /// only for points that are not close to their predictions. With `round_trip`, only points that
  /// return to within max_round_trip_px when tracked back count as tracked.
  void track(Workers& workers,
             const ImagePyramid& keyframe_pyramid,
             const ImagePyramid& cur_pyramid,
             const std::vector<cv::Point2f>& keyframe_px,
             const std::vector<float>& scales,
             bool round_trip,
             std::vector<cv::Point2f>& cur,
             std::vector<char>& tracked);

  /// Moves `point` to the position in `to` that matches the surroundings of `start` in `from`.
  /// Start near the result, and at equal scale: only one level is used, without tracking back.
  /// Returns false if nothing is found.
  bool locate(const cv::Mat& from, const cv::Mat& to, const cv::Point2f& start, cv::Point2f& point);

 private:
  Config config_;
  std::vector<TrackingWindow> windows_;  // one per part of a list
};

}  // namespace rotrocc
