#include "features/correspondence_finder.h"

#include <algorithm>
#include <cmath>

#include "common/median.h"
#include "features/base_level.h"
#include "features/image_pyramid.h"

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
  const int margin_px = cvCeil(std::ldexp(FeatureDetector::kBorder_px, level));
  left_mask_.assign(pair.left_mask, margin_px);
  right_mask_.assign(pair.right_mask, margin_px);
  frame->left_mask = left_mask_;
  frame->right_mask = right_mask_;
  const int least_px = 2 * config_.feature_tracker.window_radius_px + 1;
  const bool with_image = level <= 0;
  buildPyramid(pair.left, BaseLevel::kLevels, least_px, frame->whole_left, with_image);
  buildPyramid(pair.right, BaseLevel::kLevels, least_px, frame->whole_right, with_image);
  frame->is_enlarged = false;
  const int levels = static_cast<int>(frame->whole_left.size());
  frame->setLevel(std::min(level, levels - 1));
  return frame;
}

void CorrespondenceFinder::findCorners(Keyframe& keyframe) {
  const StereoFrame& frame = *keyframe.frame;
  detector_.detect(frame.left.front(), keyframe.corners, kCandidates, frame.left_mask);
}

void CorrespondenceFinder::findDepths(const StereoCamera& camera, int wanted, Keyframe& keyframe) {
  keyframe.left_px.clear();
  keyframe.right_px.clear();
  keyframe.points.clear();
  const RectifiedImages images = imagesOf(*keyframe.frame, camera, keyframe);
  std::size_t tried = 0;
  while (tried < keyframe.corners.size() && static_cast<int>(keyframe.points.size()) < wanted) {
    addPoint(images, keyframe.corners[tried++], keyframe);
  }
  keyframe.corners.resize(tried);
}

/// Adds the point of a corner if it has a depth. Matches are searched in whole rows first.
void CorrespondenceFinder::addPoint(const RectifiedImages& images,
                                    const cv::Point2f& corner,
                                    Keyframe& keyframe) const {
  auto match = matcher_.match(images, corner);
  if (match && keyframe.row_offset_px != 0.0) {
    match = matcher_.matchNear(images, corner, match->disparity_px);
  }
  if (!match) return;
  const double depth_m = images.camera.depth(match->disparity_px);
  if (!isUsableDepth(depth_m)) return;
  const cv::Point2f right(corner.x - match->disparity_px,
                          corner.y + static_cast<float>(keyframe.row_offset_px));
  if (keyframe.frame->right_mask.excludes(right)) return;
  keyframe.left_px.push_back(corner);
  keyframe.right_px.push_back(right);
  keyframe.points.push_back(depth_m * images.camera.ray({corner.x, corner.y}));
}

int CorrespondenceFinder::find(const StereoCamera& camera,
                               const Keyframe& keyframe,
                               const StereoFrame& current,
                               const Eigen::Isometry3d& T_keyframe_cur,
                               Correspondences& features) {
  tracker_.setWindowScale(camera.window_scale);
  const RectifiedImages images = imagesOf(current, camera, keyframe);
  const Eigen::Isometry3d T_cur_keyframe = T_keyframe_cur.inverse();
  const double dt_s = secondsBetween(*keyframe.frame, current);
  const double late = keyframe.right_delay_s == 0.0 ? 0.0 : keyframe.right_delay_s / dt_s;
  features.clear();
  gains_.clear();
  int count = 0;
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    const auto tracked = track(camera, keyframe, current, T_cur_keyframe, i);
    if (!tracked) continue;
    ++count;
    const cv::Point2f late_px = late * (tracked->right - keyframe.right_px[i]);
    const auto disparity_px = consistentDisparity(images, current, *tracked, late_px);
    if (!disparity_px) continue;
    const cv::Point2f& left = tracked->left;
    features.push_back(
        {{keyframe.left_px[i].x, keyframe.left_px[i].y}, {left.x, left.y}, *disparity_px});
  }
  stereo_gain_ = gains_.empty() ? 1.0 : median(gains_);
  triangulate(camera, features);
  return count;
}

/// Tracks a point of the keyframe from where the motion predicts it. None if it is behind the
/// camera. The right position is predicted from the tracked left one and the predicted disparity.
std::optional<CorrespondenceFinder::Tracked> CorrespondenceFinder::track(
    const StereoCamera& camera,
    const Keyframe& keyframe,
    const StereoFrame& current,
    const Eigen::Isometry3d& T_cur_keyframe,
    std::size_t i) {
  const Eigen::Vector3d point = T_cur_keyframe * keyframe.points[i];
  if (point.z() < kMinDepth_m) return std::nullopt;
  const auto scale = static_cast<float>(keyframe.points[i].z() / point.z());
  const Eigen::Vector2f predicted = camera.project(point).cast<float>();
  Tracked cur;
  cur.left = {predicted.x(), predicted.y()};
  const StereoFrame& from = *keyframe.frame;
  if (!tracker_.track(from.left, current.left, keyframe.left_px[i], scale, cur.left)) {
    return std::nullopt;
  }
  cur.right = cur.left + cv::Point2f(-static_cast<float>(camera.disparity(point.z())),
                                     static_cast<float>(keyframe.row_offset_px));
  const bool found =
      tracker_.track(from.right, current.right, keyframe.right_px[i], scale, cur.right);
  return found ? std::optional(cur) : std::nullopt;
}

/// The disparity at which the tracked positions match each other, at the time of the left image;
/// until the right image is taken, the point moves by `late_px`. None if they do not match or are
/// masked.
std::optional<float> CorrespondenceFinder::consistentDisparity(const RectifiedImages& images,
                                                               const StereoFrame& current,
                                                               const Tracked& tracked,
                                                               const cv::Point2f& late_px) {
  if (current.left_mask.excludes(tracked.left) || current.right_mask.excludes(tracked.right)) {
    return std::nullopt;
  }
  const double detail_px = images.camera.detail_px;
  const cv::Point2f offset = tracked.left - tracked.right;
  const double wrong_row_px = std::abs(offset.y + images.row_offset_px);
  if (!(wrong_row_px <= detail_px * kMaxVertical_px)) return std::nullopt;
  RectifiedImages late = images;
  late.row_offset_px += late_px.y;
  const auto match = matcher_.matchNear(late, tracked.left, offset.x);
  if (!match) return std::nullopt;
  gains_.push_back(static_cast<float>(match->gain));
  const double difference_px = std::abs(match->disparity_px - offset.x);
  if (difference_px > detail_px * kMaxDisparityDifference_px) return std::nullopt;
  return match->disparity_px + late_px.x;
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
