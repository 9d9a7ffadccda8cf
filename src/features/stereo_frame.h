#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/to_seconds.h"
#include "features/feature_mask.h"
#include "features/image_pyramid.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// The images of one stereo pair, as pyramids for the tracker. Level 0 is a copy of the image.
struct StereoFrame {
  std::int64_t stamp_ns = 0;
  ImagePyramid left, right;
  FeatureMask left_mask, right_mask;
};

/// A frame may be used as the last frame, the lost frame and the keyframe at the same time.
using FramePtr = std::shared_ptr<const StereoFrame>;

inline double secondsBetween(const StereoFrame& earlier, const StereoFrame& later) {
  return toSeconds(later.stamp_ns - earlier.stamp_ns);
}

/// The frame that motions are measured against (t-1 in the paper), and its features.
struct Keyframe {
  FramePtr frame;                    ///< null: there is no keyframe
  std::vector<cv::Point2f> corners;  ///< of the left image [px]

  double row_offset_px = 0.0;  ///< how much lower points are in the right image

  /// The corners with a depth: pixels in both images, and points in the left camera frame [m].
  std::vector<cv::Point2f> left_px, right_px;
  std::vector<Eigen::Vector3d> points;

  UncertainTransform T_keyframe_last;  ///< the pose of the last frame in the keyframe
};

}  // namespace rotrocc
