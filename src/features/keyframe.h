#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "features/stereo_frame.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

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
