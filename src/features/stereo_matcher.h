#pragma once

#include <limits>
#include <vector>

#include <opencv2/core.hpp>

#include "rotrocc/odometry_config.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Two rectified images (CV_8UC1) of the size of the camera.
struct RectifiedImages {
  const cv::Mat& left;
  const cv::Mat& right;
  const StereoCamera& camera;
  double row_offset_px = 0.0;  ///< how much lower points are in the right image
};

/// Sparse matching along the row, by zero-mean normalized cross-correlation with a sub-pixel
/// fit: neither brightness nor contrast of the cameras matters, and they may differ over the image.
class StereoMatcher {
 public:
  using Config = StereoMatcherConfig;

  /// Marks a pixel without a match.
  static constexpr float kNoDisparity = std::numeric_limits<float>::lowest();

  /// Search radius of matchNear() around the expected disparity.
  static constexpr int kNearRadius_px = 2;

  explicit StereoMatcher(const Config& config) : config_(config) {}

  /// Computes the disparity x_left - x_right [px] of each corner of the left image. Corners must be
  /// at integer pixels. The result is kNoDisparity for corners too close to the border and for
  /// matches that are too different, ambiguous or out of range. The row offset is rounded.
  void match(const RectifiedImages& images,
             const std::vector<cv::Point2f>& corners,
             std::vector<float>& disparities_px) const;

  /// As match(), but for pixels at sub-pixel positions, within kNearRadius_px of the disparities
  /// `expected_px`. Does not test for uniqueness, because the expected disparity resolves
  /// ambiguity. Pixels with an expected disparity of kNoDisparity are skipped. Returns the contrast
  /// of the right image relative to the left one: the median over the matches, or 1 if there are
  /// none.
  double matchNear(const RectifiedImages& images,
                   const std::vector<cv::Point2f>& pixels,
                   const std::vector<float>& expected_px,
                   std::vector<float>& disparities_px) const;

 private:
  Config config_;
};

}  // namespace rotrocc
