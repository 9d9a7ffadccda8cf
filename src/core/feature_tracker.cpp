#include "rotrocc/feature_tracker.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "tracking_window.h"

namespace rotrocc {
namespace {

/// Features are followed in so many parts, each with a window of its own. The parts differ in what
/// they cost; more of them than threads even that out.
constexpr int kParts = 8;

/// The place of a pixel in a pyramid's level.
float scaleOf(std::size_t level) {
  return 1.0F / static_cast<float>(1 << level);
}

}  // namespace

FeatureTracker::FeatureTracker(const Config& config)
    : config_(config), windows_(kParts, TrackingWindow(config.window_radius_px)) {}
FeatureTracker::~FeatureTracker() = default;

void FeatureTracker::buildPyramid(const cv::Mat& image, Pyramid& pyramid) const {
  const int side = 2 * config_.window_radius_px + 1;
  std::size_t levels = 1;
  const auto most = static_cast<std::size_t>(std::max(config_.levels, config_.startup_levels));
  while (levels < most && std::min(image.cols, image.rows) >> levels > side) ++levels;
  pyramid.resize(levels);
  image.copyTo(pyramid[0]);
  for (std::size_t i = 1; i < levels; ++i) cv::pyrDown(pyramid[i - 1], pyramid[i]);
}

void FeatureTracker::track(Workers& workers,
                           const Pyramid& prev_pyramid,
                           const Pyramid& cur_pyramid,
                           const std::vector<cv::Point2f>& prev,
                           int levels,
                           std::vector<cv::Point2f>& cur,
                           std::vector<char>& tracked) {
  indices_.clear();
  for (std::size_t i = 0; i < prev.size(); ++i) {
    if (tracked[i] != 0) indices_.push_back(i);
  }
  const std::size_t used =
      std::min({static_cast<std::size_t>(levels), prev_pyramid.size(), cur_pyramid.size()});
  workers.run(kParts, [&](int part) {
    const auto p = static_cast<std::size_t>(part);
    const std::size_t end = indices_.size() * (p + 1) / kParts;
    for (std::size_t k = indices_.size() * p / kParts; k < end; ++k) {
      const std::size_t i = indices_[k];
      const bool found = follow(prev_pyramid, cur_pyramid, used, prev[i], windows_[p], cur[i]);
      tracked[i] = found ? 1 : 0;
    }
  });
}

bool FeatureTracker::follow(const Pyramid& from,
                            const Pyramid& to,
                            std::size_t levels,
                            const cv::Point2f& start,
                            TrackingWindow& window,
                            cv::Point2f& end) const {
  const TrackingWindow::Stop stop = {config_.max_iterations, config_.min_step_px};
  for (std::size_t level = levels - 1; level > 0; --level) {
    const float scale = scaleOf(level);
    cv::Point2f scaled = scale * end;
    // What a small image does not show is left to the larger ones.
    if (window.take(from[level], scale * start) && window.find(to[level], stop, scaled)) {
      end = scaled / scale;
    }
  }
  if (!window.take(from[0], start) || !window.find(to[0], stop, end)) return false;

  // The way back starts where it should end, so one level is enough.
  cv::Point2f back = start;
  if (!window.take(to[0], end) || !window.find(from[0], stop, back)) return false;
  const cv::Point2f miss = back - start;
  return miss.dot(miss) <=
         static_cast<float>(config_.max_round_trip_px * config_.max_round_trip_px);
}

}  // namespace rotrocc
