#include "features/row_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace rotrocc {
namespace {

/// Number of features whose offset is measured, of all: it is cheap, and enough over a few pairs.
constexpr std::size_t kFeatures = 24;

/// Number of corners that are searched.
constexpr std::size_t kCorners = 64;

/// Where a corner was found when several rows were searched. If these are not the same place, its
/// row is unknown. In pixels of detail.
struct CornerOffset {
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

}  // namespace

RowSearch::RowSearch(const CorrespondenceFinderConfig& config)
    : matcher_(config.stereo_matcher), tracker_(config.feature_tracker) {}

std::vector<float> RowSearch::search(const StereoCamera& camera, const Keyframe& keyframe) {
  tracker_.setWindowScale(camera.window_scale);
  const cv::Mat& left = keyframe.frame->left.front();
  const cv::Mat& right = keyframe.frame->right.front();
  const auto detail_px = static_cast<float>(camera.detail_px);
  std::vector<float> offsets_px;
  const std::size_t step = std::max<std::size_t>(1, keyframe.corners.size() / kCorners);
  for (std::size_t i = 0; i < keyframe.corners.size(); i += step) {
    const cv::Point2f& corner = keyframe.corners[i];
    CornerOffset found;
    for (int rows = -kMaxRows; rows <= kMaxRows; ++rows) {
      // Matches that leave their row were found in a wrong one.
      const float lower_px = static_cast<float>(rows) * detail_px;
      const auto match = matcher_.match({left, right, camera, lower_px}, corner);
      if (!match) continue;
      cv::Point2f point = corner + cv::Point2f(-match->disparity_px, lower_px);
      if (!tracker_.locate(left, right, corner, point)) continue;
      found.add((point.y - corner.y) / detail_px, static_cast<float>(rows));
    }
    if (found.isUnique()) offsets_px.push_back(detail_px * found.nearest_px);
  }
  return offsets_px;
}

void RowSearch::measure(const StereoCamera& camera,
                        const StereoFrame& current,
                        const Correspondences& features,
                        const FeatureSet& set,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        double row_offset_px,
                        std::vector<RowSample>& samples) {
  samples.clear();
  tracker_.setWindowScale(camera.window_scale);
  const std::size_t step = std::max<std::size_t>(1, features.size() / kFeatures);
  for (std::size_t i = 0; i < features.size(); i += step) {
    if (set[i] == 0) continue;
    const Correspondence& feature = features[i];
    const cv::Point2f left(static_cast<float>(feature.cur_px.x()),
                           static_cast<float>(feature.cur_px.y()));
    cv::Point2f right = left + cv::Point2f(-static_cast<float>(feature.disparity_px),
                                           static_cast<float>(row_offset_px));
    if (tracker_.locate(current.left.front(), current.right.front(), left, right)) {
      const Eigen::Vector2d from_px = camera.project(T_keyframe_cur * feature.point_cur);
      samples.push_back({feature.cur_px, feature.cur_px - from_px, right.y - left.y});
    }
  }
}

}  // namespace rotrocc
