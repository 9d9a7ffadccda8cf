#include "features/row_search.h"

#include <algorithm>
#include <cstddef>

namespace rotrocc {
namespace {

/// Features whose offset is measured: one of this many. That is cheap, and enough over a few pairs.
constexpr std::size_t kFeatureSample = 16;

/// Number of corners that are searched, and the largest offset at which they are found.
constexpr std::size_t kCorners = 64;
constexpr int kMaxRows = 3;

}  // namespace

RowSearch::RowSearch(const CorrespondenceFinderConfig& config)
    : matcher_(config.stereo_matcher), tracker_(config.feature_tracker), workers_(1) {}

void RowSearch::search(const StereoCamera& camera,
                       const Keyframe& keyframe,
                       std::vector<float>& offsets_px) {
  sample_px_.clear();
  const std::size_t step = std::max<std::size_t>(1, keyframe.corners.size() / kCorners);
  for (std::size_t i = 0; i < keyframe.corners.size(); i += step) {
    sample_px_.push_back(keyframe.corners[i]);
  }
  found_.assign(sample_px_.size(), {});
  for (int rows = -kMaxRows; rows <= kMaxRows; ++rows) searchRow(camera, *keyframe.frame, rows);
  offsets_px.clear();
  for (const Found& found : found_) {
    if (found.isUnique()) offsets_px.push_back(found.nearest_px);
  }
}

/// Matches the sample as if the right image were lower by `rows`, and locates the matches. Those
/// that leave their row were found in a wrong one.
void RowSearch::searchRow(const StereoCamera& camera, const StereoFrame& frame, int rows) {
  const cv::Mat& left = frame.left.front();
  const cv::Mat& right = frame.right.front();
  const auto lower_px = static_cast<float>(rows);
  const RectifiedImages images = {left, right, camera.disparityAtInfinity(), lower_px};
  matcher_.match(workers_, images, sample_px_, disparities_px_);
  for (std::size_t i = 0; i < sample_px_.size(); ++i) {
    if (disparities_px_[i] == StereoMatcher::kNoDisparity) continue;
    cv::Point2f point = sample_px_[i] + cv::Point2f(-disparities_px_[i], lower_px);
    if (!tracker_.locate(left, right, sample_px_[i], point)) continue;
    found_[i].add(point.y - sample_px_[i].y, lower_px);
  }
}

void RowSearch::measure(const StereoFrame& current,
                        const Correspondences& features,
                        const FeatureSet& set,
                        double row_offset_px,
                        RowOffsets& offsets) {
  offsets.features.clear();
  offsets.offsets_px.clear();
  for (std::size_t i = 0; i < features.size(); i += kFeatureSample) {
    if (set[i] == 0) continue;
    const cv::Point2f left(static_cast<float>(features[i].cur_px.x()),
                           static_cast<float>(features[i].cur_px.y()));
    cv::Point2f right = left + cv::Point2f(-static_cast<float>(features[i].disparity_px),
                                           static_cast<float>(row_offset_px));
    if (tracker_.locate(current.left.front(), current.right.front(), left, right)) {
      offsets.features.push_back(i);
      offsets.offsets_px.push_back(right.y - left.y);
    }
  }
}

}  // namespace rotrocc
