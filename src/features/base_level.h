#pragma once

#include <array>

#include <opencv2/core.hpp>

#include "features/image_pyramid.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Chooses the level of the pyramids that is the image of the odometry: pixels that show no more
/// detail than fewer would, as those of a soft lens, a demosaiced sensor or an enlarged image, cost
/// time, and make windows and limits in pixels too small. Where an image has no room for the
/// features, windows in its pixels are too large: it is doubled, as by Lowe, "Distinctive Image
/// Features from Scale-Invariant Keypoints" (2004). Chooses the number of features, too.
///
/// The sharpness of a level is the mean square of the detail that halving it loses, relative to the
/// loss of the next halving; both exclude noise. It is 1 for a scene alike at all scales, and does
/// not depend on gain. It is averaged over pairs.
class BaseLevel {
 public:
  /// No more levels are skipped.
  static constexpr int kMaxLevel = 2;
  /// Levels that observe() needs.
  static constexpr int kLevels = kMaxLevel + 3;

  /// A soft level is skipped if the next one has room for the features, or all of its details.
  explicit BaseLevel(const FeatureDetectorConfig& config) : config_(config) {}

  void configure(const FeatureDetectorConfig& config) { config_ = config; }

  /// Adds an image, CV_8UC1, with its smaller copies. Level 0 of the pyramid is not used.
  void observe(const cv::Mat& image, const ImagePyramid& pyramid);

  /// Adds the share of a keyframe's features that agree on the motion; 0 if there is none.
  void observeSurvivors(double share);

  /// As many features as wanted_inliers need, max_features if no survivors are known.
  int wantedFeatures() const;

  /// Forgets the images, as of another camera.
  void reset() { *this = BaseLevel(config_); }

  /// -1: the doubled image.
  int level() const { return level_; }

  /// Side of the smallest detail of the images at the level [px]: 1, or more if the level is soft
  /// and the next one has no room, or if the image is doubled.
  double detail_px() const { return detail_px_; }

  /// Scale of the windows: detail_px(), or less in a doubled image without room for them.
  double window_scale() const { return window_scale_; }

 private:
  void observeLevel(const cv::Mat& image, const cv::Mat* smaller);

  FeatureDetectorConfig config_;
  int level_ = 0;
  double detail_px_ = 1.0;
  double window_scale_ = 1.0;
  double survivors_ = 0.0;
  std::array<int, kMaxLevel + 1> images_ = {};
  std::array<double, kMaxLevel + 1> log_sharpness_ = {};  // averages over the images
  std::array<bool, kMaxLevel + 1> is_soft_ = {}, is_empty_ = {};
};

}  // namespace rotrocc
