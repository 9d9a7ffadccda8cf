#include "features/correspondence_finder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/reprojection_error.h"

namespace rotrocc {
namespace {

/// Rows are compared at one feature of so many, which is cheap, and enough over a few pairs.
constexpr std::size_t kRowSample = 16;

}  // namespace

CorrespondenceFinder::CorrespondenceFinder(const Config& config, int threads)
    : config_(config),
      workers_(threads),
      detector_(config.feature_detector),
      matcher_(config.stereo_matcher),
      tracker_(config.feature_tracker) {}

void CorrespondenceFinder::configure(const Config& config, int threads) {
  CorrespondenceFinder other(config, threads);
  other.pyramids_ = std::move(pyramids_);
  other.last_ = last_;
  other.aside_ = aside_;
  *this = std::move(other);
}

void CorrespondenceFinder::take(const StereoPair& pair, const StereoCamera& camera) {
  camera_ = camera;
  current_ = 0;
  while (current_ == reference_ || current_ == last_ || current_ == aside_) ++current_;
  StereoPyramid& current = pyramids_[current_];
  workers_.run(2, [&](int side) {
    tracker_.buildPyramid(side == 0 ? pair.left : pair.right,
                          side == 0 ? current.left : current.right);
  });
}

void CorrespondenceFinder::keep() {
  last_ = current_;
}

void CorrespondenceFinder::setAside() {
  aside_ = current_;
}

void CorrespondenceFinder::takeUpAside() {
  last_ = aside_;
}

void CorrespondenceFinder::refer() {
  reference_ = last_;
}

int CorrespondenceFinder::findCorners() {
  detector_.detect(workers_, pyramids_[reference_].left.front(), corners_);
  return static_cast<int>(corners_.size());
}

int CorrespondenceFinder::findDepths() {
  ref_left_.clear();
  ref_right_.clear();
  ref_points_.clear();
  matcher_.match(workers_,
                 pyramids_[reference_].left.front(),
                 pyramids_[reference_].right.front(),
                 corners_,
                 camera_.disparityAtInfinity(),
                 disparities_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const cv::Point2f& corner = corners_[i];
    const float disparity_px = disparities_[i];
    if (disparity_px == StereoMatcher::kNoDisparity) continue;
    const double depth_m = camera_.depth(disparity_px);
    if (!std::isfinite(depth_m) || depth_m < kMinDepth_m) continue;
    ref_left_.push_back(corner);
    ref_right_.emplace_back(corner.x - disparity_px, corner.y);
    ref_points_.push_back(depth_m * camera_.ray({corner.x, corner.y}));
  }
  return static_cast<int>(ref_points_.size());
}

int CorrespondenceFinder::track(const Eigen::Isometry3d& T_keyframe_cur, bool is_prediction) {
  const Eigen::Isometry3d T_cur_ref = T_keyframe_cur.inverse();
  cur_left_.resize(ref_points_.size());
  cur_right_.resize(ref_points_.size());
  tracked_.assign(ref_points_.size(), 0);
  growth_.assign(ref_points_.size(), 1.0F);
  for (std::size_t i = 0; i < ref_points_.size(); ++i) {
    const Eigen::Vector3d point = T_cur_ref * ref_points_[i];
    if (point.z() < kMinDepth_m) continue;
    const Eigen::Vector2d left = camera_.project(point);
    cur_left_[i] = {static_cast<float>(left.x()), static_cast<float>(left.y())};
    cur_right_[i] = {static_cast<float>(camera_.disparity(point.z())),
                     0.0F};  // as yet its disparity
    growth_[i] = static_cast<float>(ref_points_[i].z() / point.z());
    tracked_[i] = 1;
  }
  FeatureTracker::Search search;
  search.levels =
      is_prediction ? config_.feature_tracker.levels : config_.feature_tracker.startup_levels;
  tracker_.track(workers_,
                 pyramids_[reference_].left,
                 pyramids_[current_].left,
                 ref_left_,
                 growth_,
                 search,
                 cur_left_,
                 tracked_);
  // Where the left image shows a feature is better known now; its disparity is as predicted.
  for (std::size_t i = 0; i < cur_left_.size(); ++i) cur_right_[i] = cur_left_[i] - cur_right_[i];
  search.near = is_prediction;
  tracker_.track(workers_,
                 pyramids_[reference_].right,
                 pyramids_[current_].right,
                 ref_right_,
                 growth_,
                 search,
                 cur_right_,
                 tracked_);
  return static_cast<int>(std::count(tracked_.begin(), tracked_.end(), 1));
}

void CorrespondenceFinder::checkCircularConsistency(Correspondences& features) {
  const FeatureTracker::Config& limits = config_.feature_tracker;
  expected_.assign(cur_left_.size(), StereoMatcher::kNoDisparity);
  for (std::size_t i = 0; i < cur_left_.size(); ++i) {
    const cv::Point2f offset = cur_left_[i] - cur_right_[i];
    if (tracked_[i] != 0 && std::abs(offset.y) <= limits.max_vertical_px) expected_[i] = offset.x;
  }
  matcher_.matchNear(workers_,
                     pyramids_[current_].left.front(),
                     pyramids_[current_].right.front(),
                     cur_left_,
                     expected_,
                     camera_.disparityAtInfinity(),
                     disparities_);

  features.clear();
  for (std::size_t i = 0; i < cur_left_.size(); ++i) {
    if (disparities_[i] == StereoMatcher::kNoDisparity) continue;
    if (std::abs(disparities_[i] - expected_[i]) > limits.max_disparity_difference_px) continue;
    const double depth_m = camera_.depth(disparities_[i]);
    if (!std::isfinite(depth_m) || depth_m < kMinDepth_m) continue;
    Correspondence feature;
    feature.prev_px = {ref_left_[i].x, ref_left_[i].y};
    feature.cur_px = {cur_left_[i].x, cur_left_[i].y};
    feature.disparity_px = disparities_[i];
    feature.point_cur = depth_m * camera_.ray(feature.cur_px);
    features.push_back(feature);
  }
}

void CorrespondenceFinder::compareRows(const Correspondences& features,
                                       const FeatureSet& set,
                                       std::vector<float>& differences_px) {
  differences_px.clear();
  for (std::size_t i = 0; i < features.size(); i += kRowSample) {
    if (set[i] == 0) continue;
    const cv::Point2f left(static_cast<float>(features[i].cur_px.x()),
                           static_cast<float>(features[i].cur_px.y()));
    cv::Point2f right(left.x - static_cast<float>(features[i].disparity_px), left.y);
    if (tracker_.locate(
            pyramids_[current_].left.front(), pyramids_[current_].right.front(), left, right)) {
      differences_px.push_back(right.y - left.y);
    }
  }
}

double CorrespondenceFinder::medianShift(const Eigen::Isometry3d& T_keyframe_cur_a,
                                         const Eigen::Isometry3d& T_keyframe_cur_b) {
  const Eigen::Isometry3d T_cur_ref_a = T_keyframe_cur_a.inverse();
  const Eigen::Isometry3d T_cur_ref_b = T_keyframe_cur_b.inverse();
  shifts_px_.clear();
  for (const Eigen::Vector3d& point : ref_points_) {
    const Eigen::Vector3d a = T_cur_ref_a * point;
    const Eigen::Vector3d b = T_cur_ref_b * point;
    if (a.z() < kMinDepth_m || b.z() < kMinDepth_m) continue;
    shifts_px_.push_back((camera_.project(a) - camera_.project(b)).norm());
  }
  if (shifts_px_.empty()) return 0.0;
  const auto middle = shifts_px_.begin() + static_cast<std::ptrdiff_t>(shifts_px_.size() / 2);
  std::nth_element(shifts_px_.begin(), middle, shifts_px_.end());
  return *middle;
}

}  // namespace rotrocc
