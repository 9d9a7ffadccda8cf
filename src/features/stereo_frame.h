#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/to_seconds.h"
#include "features/image_pyramid.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// Where an image has no features. Copies share their pixels.
class FeatureMask {
 public:
  /// Excludes the pixels that are not zero in `mask` (CV_8UC1; empty: none), and those closer to
  /// them than `margin_px`. There is nothing to do if it is the same image as before.
  void assign(const cv::Mat& mask, int margin_px) {
    if (mask.data == mask_.data) return;
    mask_ = mask;
    grown_.release();  // copies keep theirs
    if (mask.empty()) return;
    const cv::Size window(2 * margin_px + 1, 2 * margin_px + 1);
    cv::dilate(mask, grown_, cv::getStructuringElement(cv::MORPH_RECT, window));
  }

  /// From now on pixels refer to an image halved `level` times; -1: doubled.
  void setLevel(int level) { px_ = std::ldexp(1.0F, level); }

  /// Whether a pixel may not be used. Those outside the image may.
  bool excludes(const cv::Point2f& pixel) const {
    const cv::Point nearest(cvRound(px_ * pixel.x), cvRound(px_ * pixel.y));
    return cv::Rect({}, grown_.size()).contains(nearest) && grown_.at<uchar>(nearest) != 0;
  }

  /// Non-zero where features may be, as OpenCV's detectors expect it for an image of that size.
  /// Empty if that is everywhere.
  cv::Mat usable(const cv::Size& size) const {
    cv::Mat usable;
    if (!grown_.empty()) cv::resize(grown_ == 0, usable, size, 0.0, 0.0, cv::INTER_NEAREST);
    return usable;
  }

 private:
  cv::Mat mask_;  // as passed: while it is kept, no other has the same address
  cv::Mat grown_;
  float px_ = 1.0F;  // of the mask for one of the image
};

/// The images of one stereo pair.
struct StereoFrame {
  std::int64_t stamp_ns = 0;
  std::int64_t clock_set_ns = 0;  ///< see StereoPair
  std::int64_t time_ns() const { return stamp_ns - clock_set_ns; }
  ImagePyramid whole_left, whole_right;  ///< level 0 is a copy of the image, or empty
  cv::Mat large_left, large_right;       ///< level -1: enlarged images, if is_enlarged
  bool is_enlarged = false;
  /// Pyramids for the tracker: those parts of the whole ones that begin with the image of the
  /// odometry, see BaseLevel.
  ImagePyramid left, right;
  FeatureMask left_mask, right_mask;

  /// Levels of left and right, without doubled images. In the smallest one, a window of the tracker
  /// reaches four times as far, for features whose prediction is far off. What is farther is left
  /// to the search for the motion.
  static constexpr int kLevels = 3;

  bool hasImage() const { return !whole_left.front().empty(); }

  /// Sets the first level of left and right, which is 1 or more without the images.
  void setLevel(int first) {
    if (first < 0 && !std::exchange(is_enlarged, true)) {
      enlarge(whole_left.front(), large_left);
      enlarge(whole_right.front(), large_right);
    }
    const auto part = [&](const cv::Mat& large, const ImagePyramid& whole, ImagePyramid& pyramid) {
      pyramid.clear();
      if (first < 0) pyramid.push_back(large);
      const auto end = std::min(static_cast<int>(whole.size()), std::max(first, 0) + kLevels);
      pyramid.insert(pyramid.end(), whole.begin() + std::max(first, 0), whole.begin() + end);
    };
    part(large_left, whole_left, left);
    part(large_right, whole_right, right);
    left_mask.setLevel(first);
    right_mask.setLevel(first);
  }
};

/// A frame may be used as the last frame, the lost frame and the keyframe at the same time.
using FramePtr = std::shared_ptr<StereoFrame>;

inline double secondsBetween(const StereoFrame& earlier, const StereoFrame& later) {
  return toSeconds(later.time_ns() - earlier.time_ns());
}

/// The frame that motions are measured against (t-1 in the paper), and its features.
struct Keyframe {
  FramePtr frame;                    ///< null: there is no keyframe
  std::vector<cv::Point2f> corners;  ///< of the left image [px]

  double row_offset_px = 0.0;  ///< how much lower points are in the right image
  double right_delay_s = 0.0;  ///< how much later the right images are taken

  /// The corners with a depth: pixels in both images, and points in the left camera frame [m].
  std::vector<cv::Point2f> left_px, right_px;
  std::vector<Eigen::Vector3d> points;

  UncertainTransform T_keyframe_last;  ///< the pose of the last frame in the keyframe
};

}  // namespace rotrocc
