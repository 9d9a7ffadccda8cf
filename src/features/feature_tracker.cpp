#include "features/feature_tracker.h"

#include <algorithm>

namespace rotrocc {
namespace {

/// A point within this fraction of the window's radius counts as close to its prediction.
constexpr float kNear = 0.5F;

/// When iterations of a level stop. Gauss-Newton converges within a few; steps below a fraction of
/// the flow's noise, about 0.1 px, gain nothing.
constexpr TrackingWindow::Stop kStop = {6, 0.04};

/// The small images only provide a start for the large one.
constexpr TrackingWindow::Stop kRoughly = {6, 0.12};

float distance2(const cv::Point2f& a, const cv::Point2f& b) {
  const cv::Point2f difference = a - b;
  return difference.dot(difference);
}

/// Scale of pixel coordinates in a level of the pyramid.
float scaleOf(std::size_t level) {
  return 1.0F / static_cast<float>(1 << level);
}

/// The tracking of single points from one image to another.
struct Tracking {
  const FeatureTrackerConfig& config;
  const ImagePyramid& from;
  const ImagePyramid& to;
  bool round_trip;

  bool follow(const cv::Point2f& start,
              float scale,
              TrackingWindow& window,
              cv::Point2f& end) const {
    cv::Point2f found = end;
    const float near_px = kNear * static_cast<float>(config.window_radius_px);
    const bool is_near = window.take(from[0], start, scale) && window.find(to[0], kStop, found) &&
                         distance2(found, end) < near_px * near_px;
    if (!is_near) {
      found = end;
      for (std::size_t level = std::min(from.size(), to.size()) - 1; level > 0; --level) {
        const float at_level = scaleOf(level);
        cv::Point2f scaled = at_level * found;
        // Features that are not found in a small image are left to the larger ones.
        if (window.take(from[level], at_level * start, scale) &&
            window.find(to[level], kRoughly, scaled)) {
          found = scaled / at_level;
        }
      }
      if (!window.take(from[0], start, scale) || !window.find(to[0], kStop, found)) return false;
    }
    end = found;
    return !round_trip || config.max_round_trip_px == 0.0 || returns(start, scale, window, end);
  }

  /// Tracking back starts at the expected result, so one level is enough.
  bool returns(const cv::Point2f& start,
               float scale,
               TrackingWindow& window,
               const cv::Point2f& end) const {
    const auto max_px = static_cast<float>(config.max_round_trip_px);
    cv::Point2f back = start;
    return window.take(to[0], end, 1.0F / scale) && window.find(from[0], kStop, back) &&
           distance2(back, start) <= max_px * max_px;
  }
};

}  // namespace

FeatureTracker::FeatureTracker(const Config& config)
    : config_(config),
      windows_(Workers::kListParts,
               TrackingWindow(config.window_radius_px, config.ignore_brightness)) {}

void FeatureTracker::makePyramid(const cv::Mat& image, ImagePyramid& pyramid) const {
  const int side = 2 * config_.window_radius_px + 1;
  buildPyramid(image, kLevels, side, pyramid);
}

void FeatureTracker::track(Workers& workers,
                           const ImagePyramid& keyframe_pyramid,
                           const ImagePyramid& cur_pyramid,
                           const std::vector<cv::Point2f>& keyframe_px,
                           const std::vector<float>& scales,
                           bool round_trip,
                           std::vector<cv::Point2f>& cur,
                           std::vector<char>& tracked) {
  const Tracking tracking = {config_, keyframe_pyramid, cur_pyramid, round_trip};
  workers.forEach(tracked.size(), [&](std::size_t i, std::size_t part) {
    if (tracked[i] == 0) return;
    tracked[i] = tracking.follow(keyframe_px[i], scales[i], windows_[part], cur[i]) ? 1 : 0;
  });
}

bool FeatureTracker::locate(const cv::Mat& from,
                            const cv::Mat& to,
                            const cv::Point2f& start,
                            cv::Point2f& point) {
  TrackingWindow& window = windows_.front();
  return window.take(from, start, 1.0F) && window.find(to, kStop, point);
}

}  // namespace rotrocc
