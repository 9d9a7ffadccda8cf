#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "features/image_pyramid.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

class TrackingWindow;

/// Pyramidal Lucas-Kanade (Bouguet 2001) from a predicted position, checked by tracking back.
class FeatureTracker {
 public:
  using Config = FeatureTrackerConfig;

  explicit FeatureTracker(const Config& config);
  ~FeatureTracker();
  FeatureTracker(FeatureTracker&&) noexcept;
  FeatureTracker& operator=(FeatureTracker&&) noexcept;

  /// How to look for points.
  struct Search {
    int levels = 1;  ///< of the pyramids, from the smallest image to the largest
    /// The points are almost where they are expected: the smaller images are only for those that
    /// prove to be elsewhere.
    bool near = false;
  };

  /// A pyramid with as many levels as are searched. Reuses the memory of `pyramid`.
  void makePyramid(const cv::Mat& image, ImagePyramid& pyramid) const;

  /// Follows `prev` points from one image to another. `scales` has the scale change expected
  /// of each point's window, above 1 where the point comes nearer. `cur` holds the
  /// predictions and gets the results; `tracked` gets 1 for points that came back to within
  /// max_round_trip_px, else 0. Points whose `tracked` is 0 at the call are skipped.
  void track(Workers& workers,
             const ImagePyramid& prev_pyramid,
             const ImagePyramid& cur_pyramid,
             const std::vector<cv::Point2f>& prev,
             const std::vector<float>& scales,
             const Search& search,
             std::vector<cv::Point2f>& cur,
             std::vector<char>& tracked);

  /// Moves `point` of one image to where it shows what another shows at `start`, from near by and
  /// of one size: one level, without the way back. Returns false if nothing is found.
  bool locate(const cv::Mat& from, const cv::Mat& to, const cv::Point2f& start, cv::Point2f& point);

 private:
  bool follow(const ImagePyramid& from,
              const ImagePyramid& to,
              const Search& search,
              const cv::Point2f& start,
              float scale,
              TrackingWindow& window,
              cv::Point2f& end) const;
  bool returns(const cv::Mat& from,
               const cv::Mat& to,
               const cv::Point2f& start,
               float scale,
               TrackingWindow& window,
               const cv::Point2f& end) const;

  Config config_;
  std::vector<TrackingWindow> windows_;  // one for each part of a list
  std::vector<std::size_t> indices_;     // of the points that are asked for
};

}  // namespace rotrocc
