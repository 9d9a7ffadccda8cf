#include "features/feature_tracker.h"

#include <algorithm>

#include "features/tracking_window.h"

namespace rotrocc {
namespace {

/// A point within this fraction of the window's radius counts as close to its prediction.
constexpr float kNear = 0.5F;

/// The small images only provide a start for the large one, so their iterations stop at a step this
/// many times as long.
constexpr double kCoarser = 3.0;

float distance2(const cv::Point2f& a, const cv::Point2f& b) {
  const cv::Point2f difference = a - b;
  return difference.dot(difference);
}

/// Scale of pixel coordinates in a level of the pyramid.
float scaleOf(std::size_t level) {
  return 1.0F / static_cast<float>(1 << level);
}

}  // namespace

FeatureTracker::FeatureTracker(const Config& config)
    : config_(config),
      windows_(Workers::kListParts,
               TrackingWindow(config.window_radius_px, config.ignore_brightness)) {}
FeatureTracker::~FeatureTracker() = default;
FeatureTracker::FeatureTracker(FeatureTracker&&) noexcept = default;
FeatureTracker& FeatureTracker::operator=(FeatureTracker&&) noexcept = default;

void FeatureTracker::makePyramid(const cv::Mat& image, ImagePyramid& pyramid) const {
  const int side = 2 * config_.window_radius_px + 1;
  buildPyramid(image, std::max(config_.levels, config_.startup_levels), side, pyramid);
}

double FeatureTracker::track(Workers& workers,
                             const ImagePyramid& keyframe_pyramid,
                             const ImagePyramid& cur_pyramid,
                             const std::vector<cv::Point2f>& keyframe_px,
                             const std::vector<float>& scales,
                             const Search& search,
                             std::vector<cv::Point2f>& cur,
                             std::vector<char>& tracked) {
  const auto followAll = [&](const std::vector<std::size_t>& indices, double gain) {
    workers.forEach(indices.size(), [&](std::size_t k, std::size_t part) {
      const std::size_t i = indices[k];
      const bool found = follow(keyframe_pyramid,
                                cur_pyramid,
                                search,
                                keyframe_px[i],
                                scales[i],
                                gain,
                                windows_[part],
                                cur[i]);
      tracked[i] = found ? 1 : 0;
    });
  };
  divide(tracked);
  predictions_.clear();
  for (const std::size_t i : sample_) predictions_.push_back(cur[i]);
  const double expected = expectedGain(keyframe_pyramid, cur_pyramid);
  followAll(sample_, expected);
  gain_.clear();
  for (const std::size_t i : sample_) {
    if (tracked[i] != 0) gain_.add(keyframe_pyramid[0], keyframe_px[i], cur_pyramid[0], cur[i]);
  }
  const double measured = gain_.median(expected);
  const double gain = usedGain(measured, WindowGain::kTemporalNoise);
  if (gain != expected) {
    for (std::size_t k = 0; k < sample_.size(); ++k) cur[sample_[k]] = predictions_[k];
    followAll(sample_, gain);
  }
  followAll(indices_, gain);
  return measured;
}

double FeatureTracker::usedGain(double gain, double noise) const {
  return config_.ignore_brightness ? beyondNoise(gain, noise) : 1.0;
}

/// A first estimate, so that the sample is found at any gain.
double FeatureTracker::expectedGain(const ImagePyramid& from, const ImagePyramid& to) const {
  const std::size_t level = std::min<std::size_t>(1, std::min(from.size(), to.size()) - 1);
  return usedGain(compareExposures(from[level], to[level]).gain, WindowGain::kTemporalNoise);
}

/// Selects the points to track, and a sample of them, which measures the gain.
void FeatureTracker::divide(const std::vector<char>& wanted) {
  const auto count = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), 1));
  const std::size_t step = WindowGain::step(count);
  indices_.clear();
  sample_.clear();
  std::size_t k = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] != 0) (k++ % step == 0 ? sample_ : indices_).push_back(i);
  }
}

bool FeatureTracker::locate(const cv::Mat& from,
                            const cv::Mat& to,
                            const cv::Point2f& start,
                            double gain,
                            cv::Point2f& point) {
  const TrackingWindow::Stop stop = {config_.max_iterations, config_.min_step_px};
  TrackingWindow& window = windows_.front();
  const double used = usedGain(gain, WindowGain::kStereoNoise);
  return window.take(from, start, 1.0F, used) && window.find(to, stop, point);
}

bool FeatureTracker::follow(const ImagePyramid& from,
                            const ImagePyramid& to,
                            const Search& search,
                            const cv::Point2f& start,
                            float scale,
                            double gain,
                            TrackingWindow& window,
                            cv::Point2f& end) const {
  const TrackingWindow::Stop stop = {config_.max_iterations, config_.min_step_px};
  const TrackingWindow::Stop roughly = {config_.max_iterations, kCoarser * config_.min_step_px};
  cv::Point2f found = end;
  const float near_px = kNear * static_cast<float>(config_.window_radius_px);
  const bool is_near = search.near && window.take(from[0], start, scale, gain) &&
                       window.find(to[0], stop, found) && distance2(found, end) < near_px * near_px;
  if (!is_near) {
    found = end;
    const auto wanted = static_cast<std::size_t>(search.levels);
    for (std::size_t level = std::min({wanted, from.size(), to.size()}) - 1; level > 0; --level) {
      const float at_level = scaleOf(level);
      cv::Point2f scaled = at_level * found;
      // Features that are not found in a small image are left to the larger ones.
      if (window.take(from[level], at_level * start, scale, gain) &&
          window.find(to[level], roughly, scaled)) {
        found = scaled / at_level;
      }
    }
    if (!window.take(from[0], start, scale, gain) || !window.find(to[0], stop, found)) return false;
  }
  end = found;
  return !search.round_trip || config_.max_round_trip_px == 0.0 ||
         returns(from[0], to[0], start, scale, gain, window, end);
}

/// Tracking back starts at the expected result, so one level is enough.
bool FeatureTracker::returns(const cv::Mat& from,
                             const cv::Mat& to,
                             const cv::Point2f& start,
                             float scale,
                             double gain,
                             TrackingWindow& window,
                             const cv::Point2f& end) const {
  const TrackingWindow::Stop stop = {config_.max_iterations, config_.min_step_px};
  const auto most_px = static_cast<float>(config_.max_round_trip_px);
  cv::Point2f back = start;
  return window.take(to, end, 1.0F / scale, 1.0 / gain) && window.find(from, stop, back) &&
         distance2(back, start) <= most_px * most_px;
}

}  // namespace rotrocc
