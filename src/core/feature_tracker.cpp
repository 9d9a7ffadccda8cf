#include "rotrocc/feature_tracker.h"

#include <algorithm>

#include <opencv2/video/tracking.hpp>

namespace rotrocc {

FeatureTracker::FeatureTracker(const Config& config)
    : config_(config), window_(2 * config.window_radius_px + 1, 2 * config.window_radius_px + 1) {}

void FeatureTracker::buildPyramid(const cv::Mat& image, Pyramid& pyramid) const {
  cv::buildOpticalFlowPyramid(image,
                              pyramid,
                              window_,
                              std::max(config_.levels, config_.startup_levels) - 1,
                              true,
                              cv::BORDER_REFLECT_101,
                              cv::BORDER_CONSTANT,
                              false);
}

void FeatureTracker::track(const Pyramid& prev_pyramid,
                           const Pyramid& cur_pyramid,
                           const std::vector<cv::Point2f>& prev,
                           int levels,
                           std::vector<cv::Point2f>& cur,
                           std::vector<char>& tracked) {
  indices_.clear();
  from_.clear();
  to_.clear();
  for (std::size_t i = 0; i < prev.size(); ++i) {
    if (tracked[i] == 0) continue;
    indices_.push_back(static_cast<int>(i));
    from_.push_back(prev[i]);
    to_.push_back(cur[i]);
  }
  if (from_.empty()) return;

  const auto flow = [&](const Pyramid& a,
                        const Pyramid& b,
                        const std::vector<cv::Point2f>& points,
                        int max_level,
                        std::vector<cv::Point2f>& result,
                        std::vector<unsigned char>& found) {
    const cv::TermCriteria stop(cv::TermCriteria::COUNT | cv::TermCriteria::EPS,
                                config_.max_iterations,
                                config_.min_step_px);
    cv::calcOpticalFlowPyrLK(a,
                             b,
                             points,
                             result,
                             found,
                             differences_,
                             window_,
                             max_level,
                             stop,
                             cv::OPTFLOW_USE_INITIAL_FLOW);
  };
  flow(prev_pyramid, cur_pyramid, from_, levels - 1, to_, found_);
  // The way back starts where it should end, so one level is enough.
  back_ = from_;
  flow(cur_pyramid, prev_pyramid, to_, 0, back_, returned_);

  const auto limit = static_cast<float>(config_.max_round_trip_px * config_.max_round_trip_px);
  for (std::size_t k = 0; k < indices_.size(); ++k) {
    const auto i = static_cast<std::size_t>(indices_[k]);
    const cv::Point2f miss = back_[k] - from_[k];
    tracked[i] = found_[k] != 0 && returned_[k] != 0 && miss.dot(miss) <= limit ? 1 : 0;
    cur[i] = to_[k];
  }
}

}  // namespace rotrocc
