#pragma once

#include <limits>
#include <vector>

#include <opencv2/core.hpp>

#include "features/image_pyramid.h"
#include "kernels/kernels.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// The window around a feature, to be located in another image: one level of Lucas-Kanade (Bouguet
/// 2001). A difference in brightness and one in contrast are estimated together with the shift, as
/// in Baker, Gross, Ishikawa and Matthews, "Lucas-Kanade 20 Years On: Part 2" (2003), so changes of
/// exposure have no effect.
/// Gray levels are interpolated in steps of 1/64, gradients in steps of 1/32, and sums are exact,
/// so results are the same with and without SIMD.
class TrackingWindow {
 public:
  struct Stop {
    double min_step_px;  ///< iterations stop at a shorter step
    /// The search fails farther from its start.
    double max_shift_px = std::numeric_limits<double>::infinity();
  };

  /// The window is a square of side 2 radius + 1; the radius is at most 25 px.
  explicit TrackingWindow(int radius_px);

  int radius() const { return radius_; }

  /// Stores the window around `center` of `image` (CV_8UC1), with its content enlarged by `scale` >
  /// 0. Returns false if the center is outside the image or the texture is too weak to locate the
  /// window.
  bool take(const cv::Mat& image, const cv::Point2f& center, float scale);

  /// Moves `center` to the position in `image` that matches the stored window. Returns false, with
  /// `center` unchanged, if the search leaves the image or goes too far.
  bool find(const cv::Mat& image, const Stop& stop, cv::Point2f& center);

  /// Correlation coefficient of the window with the last place that was compared, -1 to 1.
  double correlation() const { return correlation_; }

 private:
  Patch patchAround(const cv::Mat& image, const cv::Point2f& center, int radius, float scale);
  Patch resample(const cv::Mat& image, const cv::Point2f& center, int radius, float scale);
  bool describeContrast(const WindowSums& sums);
  bool invertNormalMatrix(const WindowSums& sums);
  cv::Point2f stepFrom(const Patch& patch);

  const Kernels* kernels_;
  int radius_, side_;
  Window window_ = {};
  std::vector<uchar> copy_;           // a patch that extends beyond the image, or of another scale
  cv::Point2d mean_gradient_;         // [gray levels / px]
  double mean_contrast_ = 0.0;        // [gray levels]
  double contrast_square_ = 0.0;      // sum of squares about the mean
  cv::Point2d gradient_by_contrast_;  // slope of the regression [1 / px]
  double correlation_ = 0.0;
  float inverse_xx_ = 0.0F, inverse_xy_ = 0.0F, inverse_yy_ = 0.0F;
};

/// Pyramidal Lucas-Kanade (Bouguet 2001), starting at a predicted position and verified by the
/// correlation of the windows.
class FeatureTracker {
 public:
  using Config = FeatureTrackerConfig;

  explicit FeatureTracker(const Config& config);

  /// Sets StereoCamera::window_scale of the images that are tracked; window radii are rounded up.
  void setWindowScale(double scale);

  /// Tracks the point `start` from one image to another. `scale` is the expected scale change of
  /// its window, above 1 if the point comes nearer. `end` is the prediction and becomes the result.
  /// Returns false, with `end` unchanged, if the point is not found or the prediction is outside
  /// the image. The smaller images of the pyramids are used only for a point that is not close to
  /// its prediction.
  bool track(const ImagePyramid& from,
             const ImagePyramid& to,
             const cv::Point2f& start,
             float scale,
             cv::Point2f& end);

  /// Moves `point` to the position in `to` that matches the surroundings of `start` in `from`.
  /// Start near the result, and at equal scale: only one level is used, whatever the correlation.
  /// Returns false if nothing is found.
  bool locate(const cv::Mat& from, const cv::Mat& to, const cv::Point2f& start, cv::Point2f& point);

 private:
  Config config_;
  double window_scale_ = 1.0;
  TrackingWindow window_, small_window_;  // in the first image of a pyramid, in a smaller one
};

}  // namespace rotrocc
