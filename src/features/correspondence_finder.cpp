#include "features/correspondence_finder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/median.h"
#include "features/base_level.h"

namespace rotrocc {
namespace {

/// Corners found for each feature that is wanted. More than half have a disparity, and at least a
/// quarter where left and right differ much.
constexpr int kCandidates = 4;

// In details of the images:

/// Tolerance of the row of left and right. Rectified rows agree to a fraction of a pixel, and a
/// constant offset is corrected.
constexpr double kMaxVertical_px = 1.0;

/// Between tracked and matched disparity. Correct ones differ by less, as both find the same point.
constexpr double kMaxDisparityDifference_px = 1.0;

/// Those of a frame, whose rows are as far apart as those of the keyframe.
RectifiedImages imagesOf(const StereoFrame& frame,
                         const StereoCamera& camera,
                         const Keyframe& keyframe) {
  return {frame.left.front(), frame.right.front(), camera, keyframe.row_offset_px};
}

}  // namespace

CorrespondenceFinder::CorrespondenceFinder(const Config& config)
    : config_(config),
      detector_(config.feature_detector),
      matcher_(config.stereo_matcher),
      tracker_(config.feature_tracker) {}

std::shared_ptr<StereoFrame> CorrespondenceFinder::unusedFrame() {
  for (const auto& frame : frames_) {
    if (frame.use_count() == 1) return frame;
  }
  return frames_.emplace_back(std::make_shared<StereoFrame>());
}

FramePtr CorrespondenceFinder::makeFrame(const StereoPair& pair, int level) {
  const auto frame = unusedFrame();
  frame->stamp_ns = pair.stamp_ns;
  frame->clock_set_ns = pair.clock_set_ns;
  left_mask_.assign(pair.left_mask, FeatureDetector::kBorder_px << level);
  right_mask_.assign(pair.right_mask, FeatureDetector::kBorder_px << level);
  frame->left_mask = left_mask_;
  frame->right_mask = right_mask_;
  tracker_.makePyramid(pair.left, BaseLevel::kLevels, frame->whole_left);
  tracker_.makePyramid(pair.right, BaseLevel::kLevels, frame->whole_right);
  const int levels = static_cast<int>(frame->whole_left.size());
  frame->setLevel(std::min(level, levels - 1));
  return frame;
}

void CorrespondenceFinder::findCorners(Keyframe& keyframe) {
  const StereoFrame& frame = *keyframe.frame;
  detector_.detect(frame.left.front(), keyframe.corners, kCandidates, frame.left_mask);
}

void CorrespondenceFinder::findDepths(const StereoCamera& camera, Keyframe& keyframe) {
  keyframe.left_px.clear();
  keyframe.right_px.clear();
  keyframe.points.clear();
  const auto wanted = static_cast<std::size_t>(config_.feature_detector.max_features);
  std::size_t tried = 0;
  while (keyframe.points.size() < wanted && tried < keyframe.corners.size()) {
    const std::size_t missing = wanted - keyframe.points.size();
    const std::size_t left = keyframe.corners.size() - tried;
    // Of the next corners, about the same share has a depth; a few too many cost less than another
    // batch.
    const std::size_t enough = keyframe.points.empty()
                                   ? std::max(missing, tried)
                                   : missing * tried / keyframe.points.size() + missing / 4 + 1;
    const auto first = keyframe.corners.begin() + static_cast<std::ptrdiff_t>(tried);
    const std::size_t count = std::min(enough, left);
    batch_.assign(first, first + static_cast<std::ptrdiff_t>(count));
    matchBatch(camera, keyframe);
    tried += addPoints(camera, wanted, keyframe);
  }
  keyframe.corners.resize(tried);
}

/// Adds the points of the batch up to the number that is wanted. Returns the number of corners that
/// it took.
std::size_t CorrespondenceFinder::addPoints(const StereoCamera& camera,
                                            std::size_t wanted,
                                            Keyframe& keyframe) const {
  const auto lower_px = static_cast<float>(keyframe.row_offset_px);
  std::size_t i = 0;
  for (; i < batch_.size() && keyframe.points.size() < wanted; ++i) {
    const cv::Point2f& corner = batch_[i];
    const float disparity_px = disparities_px_[i];
    if (disparity_px == StereoMatcher::kNoDisparity) continue;
    const double depth_m = camera.depth(disparity_px);
    if (!isUsableDepth(depth_m)) continue;
    const cv::Point2f right(corner.x - disparity_px, corner.y + lower_px);
    if (keyframe.frame->right_mask.excludes(right)) continue;
    keyframe.left_px.push_back(corner);
    keyframe.right_px.push_back(right);
    keyframe.points.push_back(depth_m * camera.ray({corner.x, corner.y}));
  }
  return i;
}

/// Finds the disparities of the batch. Matches are searched in whole rows first.
void CorrespondenceFinder::matchBatch(const StereoCamera& camera, const Keyframe& keyframe) {
  const RectifiedImages images = imagesOf(*keyframe.frame, camera, keyframe);
  matcher_.match(images, batch_, disparities_px_);
  if (keyframe.row_offset_px == 0.0) return;
  std::swap(matched_disparities_px_, disparities_px_);
  matcher_.matchNear(images, batch_, matched_disparities_px_, disparities_px_);
}

int CorrespondenceFinder::find(const StereoCamera& camera,
                               const Keyframe& keyframe,
                               const StereoFrame& current,
                               const Eigen::Isometry3d& T_keyframe_cur,
                               Correspondences& features) {
  tracker_.setDetail(camera.detail_px);
  predict(camera, keyframe, T_keyframe_cur);
  track(keyframe, current);
  checkCircularConsistency(camera, keyframe, current, features);
  return static_cast<int>(std::count(tracked_.begin(), tracked_.end(), 1));
}

/// Predicts the positions of the keyframe's points in the current images. Points behind the camera
/// are not tracked.
void CorrespondenceFinder::predict(const StereoCamera& camera,
                                   const Keyframe& keyframe,
                                   const Eigen::Isometry3d& T_keyframe_cur) {
  const Eigen::Isometry3d T_cur_keyframe = T_keyframe_cur.inverse();
  const std::size_t count = keyframe.points.size();
  cur_left_px_.resize(count);
  cur_right_px_.resize(count);
  predicted_disparities_px_.resize(count);
  scale_changes_.assign(count, 1.0F);
  tracked_.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d point = T_cur_keyframe * keyframe.points[i];
    if (point.z() < kMinDepth_m) continue;
    const Eigen::Vector2d left = camera.project(point);
    cur_left_px_[i] = {static_cast<float>(left.x()), static_cast<float>(left.y())};
    predicted_disparities_px_[i] = static_cast<float>(camera.disparity(point.z()));
    scale_changes_[i] = static_cast<float>(keyframe.points[i].z() / point.z());
    tracked_[i] = 1;
  }
}

void CorrespondenceFinder::track(const Keyframe& keyframe, const StereoFrame& current) {
  constexpr bool kRoundTrip = true;
  tracker_.track(keyframe.frame->left,
                 current.left,
                 keyframe.left_px,
                 scale_changes_,
                 kRoundTrip,
                 cur_left_px_,
                 tracked_);
  // Predict the right position from the tracked left position and the predicted disparity. The
  // disparity shows whether it is right, so it is not tracked back.
  const auto lower_px = static_cast<float>(keyframe.row_offset_px);
  for (std::size_t i = 0; i < cur_left_px_.size(); ++i) {
    cur_right_px_[i] = cur_left_px_[i] + cv::Point2f(-predicted_disparities_px_[i], lower_px);
  }
  tracker_.track(keyframe.frame->right,
                 current.right,
                 keyframe.right_px,
                 scale_changes_,
                 !kRoundTrip,
                 cur_right_px_,
                 tracked_);
}

void CorrespondenceFinder::checkCircularConsistency(const StereoCamera& camera,
                                                    const Keyframe& keyframe,
                                                    const StereoFrame& current,
                                                    Correspondences& features) {
  tracked_disparities_px_.assign(cur_left_px_.size(), StereoMatcher::kNoDisparity);
  for (std::size_t i = 0; i < cur_left_px_.size(); ++i) {
    if (current.left_mask.excludes(cur_left_px_[i])) continue;
    if (current.right_mask.excludes(cur_right_px_[i])) continue;
    const cv::Point2f offset = cur_left_px_[i] - cur_right_px_[i];
    const double wrong_row_px = std::abs(offset.y + keyframe.row_offset_px);
    if (tracked_[i] != 0 && wrong_row_px <= camera.detail_px * kMaxVertical_px) {
      tracked_disparities_px_[i] = offset.x;
    }
  }
  const RectifiedImages images = imagesOf(current, camera, keyframe);
  stereo_gain_ = matcher_.matchNear(images, cur_left_px_, tracked_disparities_px_, disparities_px_);

  features.clear();
  for (std::size_t i = 0; i < cur_left_px_.size(); ++i) {
    const float disparity_px = disparities_px_[i];
    if (disparity_px == StereoMatcher::kNoDisparity) continue;
    const double difference_px = std::abs(disparity_px - tracked_disparities_px_[i]);
    if (difference_px > camera.detail_px * kMaxDisparityDifference_px) continue;
    features.push_back({{keyframe.left_px[i].x, keyframe.left_px[i].y},
                        {cur_left_px_[i].x, cur_left_px_[i].y},
                        disparity_px});
  }
  triangulate(camera, features);
}

double CorrespondenceFinder::medianShift(const StereoCamera& camera,
                                         const Keyframe& keyframe,
                                         const Eigen::Isometry3d& T_keyframe_cur_a,
                                         const Eigen::Isometry3d& T_keyframe_cur_b) {
  const Eigen::Isometry3d T_cur_keyframe_a = T_keyframe_cur_a.inverse();
  const Eigen::Isometry3d T_cur_keyframe_b = T_keyframe_cur_b.inverse();
  shifts_px_.clear();
  for (const Eigen::Vector3d& point : keyframe.points) {
    const Eigen::Vector3d a = T_cur_keyframe_a * point;
    const Eigen::Vector3d b = T_cur_keyframe_b * point;
    if (a.z() < kMinDepth_m || b.z() < kMinDepth_m) continue;
    shifts_px_.push_back((camera.project(a) - camera.project(b)).norm());
  }
  return shifts_px_.empty() ? 0.0 : median(shifts_px_);
}

}  // namespace rotrocc
