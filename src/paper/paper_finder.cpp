#include "paper/paper_finder.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace rotrocc {
namespace {

// The paper gives no parameters of these functions.

/// Corners: least strength, as a share of the strongest one's, and least distance.
constexpr double kMinQuality = 0.005;
constexpr double kMinDistance_px = 8.0;

/// Block matching: side of a block, a multiple of which disparities OpenCV searches, and by how
/// many percent the second best match must be worse.
constexpr int kBlock_px = 11;
constexpr int kDisparityStep_px = 16;
constexpr int kUniqueness_percent = 10;

/// Lucas-Kanade: number of times that the image is halved, and when a window has settled.
constexpr int kHalvings = 3;
constexpr int kMaxIterations = 30;
constexpr double kSettled_px = 0.01;

/// Left-right consistency at t: tolerance of rows, and between tracked and matched disparity.
constexpr double kMaxDifference_px = 1.0;

bool isIn(const cv::Mat& image, const cv::Point2f& pixel) {
  return cv::Rect({}, image.size()).contains({cvRound(pixel.x), cvRound(pixel.y)});
}

float valueAt(const cv::Mat& disparities, const cv::Point2f& pixel) {
  return disparities.at<float>(cvRound(pixel.y), cvRound(pixel.x));
}

}  // namespace

void PaperFinder::findCorners(Keyframe& keyframe) {
  const cv::Mat& image = keyframe.frame->left.front();
  cv::goodFeaturesToTrack(image,
                          keyframe.corners,
                          config().feature_detector.max_features,
                          kMinQuality,
                          kMinDistance_px,
                          keyframe.frame->left_mask.usable(image.size()));
}

void PaperFinder::findDepths(const StereoCamera& camera, int /*wanted*/, Keyframe& keyframe) {
  keyframe.left_px.clear();
  keyframe.right_px.clear();
  keyframe.points.clear();
  const cv::Mat disparities = matchBlocks(camera, *keyframe.frame);
  for (const cv::Point2f& corner : keyframe.corners) {
    const float disparity_px = valueAt(disparities, corner);
    const cv::Point2f right(corner.x - disparity_px, corner.y);
    if (!isUsable(camera, disparity_px) || keyframe.frame->right_mask.excludes(right)) continue;
    keyframe.left_px.push_back(corner);
    keyframe.right_px.push_back(right);
    keyframe.points.push_back(camera.depth(disparity_px) * camera.ray({corner.x, corner.y}));
  }
}

int PaperFinder::find(const StereoCamera& camera,
                      const Keyframe& keyframe,
                      const StereoFrame& current,
                      const Eigen::Isometry3d& T_keyframe_cur,
                      Correspondences& features) {
  features.clear();
  const Eigen::Isometry3d T_cur_keyframe = T_keyframe_cur.inverse();
  std::vector<cv::Point2f> before_left, before_right, left, right;
  std::vector<float> predicted_px;
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    const Eigen::Vector3d point = T_cur_keyframe * keyframe.points[i];
    if (!isUsableDepth(point.z())) continue;
    const Eigen::Vector2f pixel = camera.project(point).cast<float>();
    before_left.push_back(keyframe.left_px[i]);
    before_right.push_back(keyframe.right_px[i]);
    left.emplace_back(pixel.x(), pixel.y());
    predicted_px.push_back(static_cast<float>(camera.disparity(point.z())));
  }
  const auto in_left = track(keyframe.frame->left.front(), current.left.front(), before_left, left);
  for (std::size_t i = 0; i < left.size(); ++i) {
    right.push_back(left[i] - cv::Point2f(predicted_px[i], 0.0F));
  }
  const auto in_right =
      track(keyframe.frame->right.front(), current.right.front(), before_right, right);

  const cv::Mat disparities = matchBlocks(camera, current);
  int tracked = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (in_left[i] == 0 || in_right[i] == 0) continue;
    ++tracked;
    const cv::Point2f offset = left[i] - right[i];
    if (std::abs(offset.y) > kMaxDifference_px || !isUsable(camera, offset.x)) continue;
    if (std::abs(valueAt(disparities, left[i]) - offset.x) > kMaxDifference_px) continue;
    if (current.left_mask.excludes(left[i]) || current.right_mask.excludes(right[i])) continue;
    features.push_back({{before_left[i].x, before_left[i].y}, {left[i].x, left[i].y}, offset.x});
  }
  triangulate(camera, features);
  return tracked;
}

/// Disparities of the left image [px] (CV_32FC1), below that at infinity where there is none.
cv::Mat PaperFinder::matchBlocks(const StereoCamera& camera, const StereoFrame& frame) const {
  const cv::Mat& left = frame.left.front();
  const int nearest = cvFloor(camera.disparityAtInfinity());
  cv::Mat disparities(left.size(), CV_32FC1, cv::Scalar(nearest - 1));
  if (std::min(left.cols, left.rows) < kBlock_px) return disparities;
  const int searched = cv::alignSize(cvCeil(camera.fx / config().stereo_matcher.nearest_baselines),
                                     kDisparityStep_px);
  const auto matcher = cv::StereoBM::create(searched, kBlock_px);
  matcher->setMinDisparity(nearest);
  matcher->setUniquenessRatio(kUniqueness_percent);
  cv::Mat sixteenths;
  matcher->compute(left, frame.right.front(), sixteenths);
  sixteenths.convertTo(disparities, CV_32F, 1.0 / cv::StereoMatcher::DISP_SCALE);
  return disparities;
}

bool PaperFinder::isUsable(const StereoCamera& camera, double disparity_px) const {
  const StereoMatcherConfig& limits = config().stereo_matcher;
  const double above_infinity_px = disparity_px - camera.disparityAtInfinity();
  return above_infinity_px >= limits.min_disparity_px &&
         above_infinity_px <= camera.fx / limits.nearest_baselines &&
         isUsableDepth(camera.depth(disparity_px));
}

/// Tracks the pixels, starting at `to_px`. Returns which of them were found in the image.
std::vector<uchar> PaperFinder::track(const cv::Mat& from,
                                      const cv::Mat& to,
                                      const std::vector<cv::Point2f>& from_px,
                                      std::vector<cv::Point2f>& to_px) const {
  if (from_px.empty()) return {};
  const int side = 2 * config().feature_tracker.window_radius_px + 1;
  std::vector<uchar> found;
  std::vector<float> unused;
  cv::calcOpticalFlowPyrLK(
      from,
      to,
      from_px,
      to_px,
      found,
      unused,
      {side, side},
      kHalvings,
      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kMaxIterations, kSettled_px},
      cv::OPTFLOW_USE_INITIAL_FLOW);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!isIn(to, to_px[i])) found[i] = 0;
  }
  return found;
}

}  // namespace rotrocc
