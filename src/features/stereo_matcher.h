#pragma once

#include <optional>

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

struct StereoMatch {
  float disparity_px;  ///< x_left - x_right
  double gain;         ///< contrast of the right window relative to the left one
};

/// Sparse matching along the row, by zero-mean normalized cross-correlation with a sub-pixel
/// fit: neither brightness nor contrast of the cameras matters, and they may differ over the image.
class StereoMatcher {
 public:
  using Config = StereoMatcherConfig;

  /// Search radius of matchNear() around the expected disparity.
  static constexpr int kNearRadius_px = 2;

  explicit StereoMatcher(const Config& config) : config_(config) {}

  /// The match of a corner of the left image, which must be at integer pixels. None for a corner
  /// too close to the border, and for a match that is too different, ambiguous or out of range. The
  /// row offset is rounded.
  std::optional<StereoMatch> match(const RectifiedImages& images, const cv::Point2f& corner) const;

  /// As match(), but for a pixel at a sub-pixel position, within kNearRadius_px of the disparity
  /// `expected_px`, which must be finite. Does not test for uniqueness, because the expected
  /// disparity resolves ambiguity.
  std::optional<StereoMatch> matchNear(const RectifiedImages& images,
                                       const cv::Point2f& pixel,
                                       float expected_px) const;

 private:
  double leastDisparity(const StereoCamera& camera) const;

  Config config_;
};

}  // namespace rotrocc
