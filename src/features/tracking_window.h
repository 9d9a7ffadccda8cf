#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kernels/kernels.h"

namespace rotrocc {

/// The window around a feature, to be located in another image: one level of Lucas-Kanade (Bouguet
/// 2001). A constant brightness difference is estimated too, and a difference in contrast is taken
/// into account if it is known, so changes of exposure have no effect.
/// Grey levels are interpolated in steps of 1/64, gradients in steps of 1/32, and sums are exact,
/// so results are the same with and without SIMD.
class TrackingWindow {
 public:
  struct Stop {
    int max_iterations;
    double min_step_px;  ///< iterations stop at a shorter step
  };

  /// The window is a square of side 2 radius + 1; the radius is at most 25 px. With
  /// `ignores_brightness`, the mean of each window is subtracted.
  explicit TrackingWindow(int radius_px, bool ignores_brightness = true);

  /// Stores the window around `center` of `image` (CV_8UC1), with its content enlarged by `scale` >
  /// 0 (a first-order approximation, accurate enough for changes of a tenth) and its contrast
  /// multiplied by `gain`. Returns false if the centre is outside the image or the texture is too
  /// weak to locate the window.
  bool take(const cv::Mat& image, const cv::Point2f& center, float scale, double gain);

  /// Moves `center` to the position in `image` that matches the stored window. Returns false, with
  /// `center` unchanged, if the search leaves the image.
  bool find(const cv::Mat& image, const Stop& stop, cv::Point2f& center);

 private:
  Patch patchAround(const cv::Mat& image, const cv::Point2f& center, int radius, int columns);
  void copyWithEdge(const cv::Mat& image, const cv::Rect& area);
  int wholeRegisters(int count) const;
  Window window();
  void spread(float scale);
  bool invertNormalMatrix(const GradientSums& sums);
  void changeContrast(double gain);
  cv::Point2f mismatch(const Patch& patch, const Window& window) const;

  const Kernels* kernels_;
  int radius_, side_;
  bool ignores_brightness_;
  int stride_;         // row length: the side, rounded up to whole registers
  int sample_stride_;  // row length of samples_
  std::vector<std::int16_t> samples_, values_, gradient_x_, gradient_y_, mask_, spread_;
  std::vector<uchar> border_;  // copy of a patch that extends beyond the image border
  cv::Point2d mean_gradient_;  // [grey levels / px]
  cv::Point2d contrast_;       // mismatch that a change of contrast causes
  float inverse_xx_ = 0.0F, inverse_xy_ = 0.0F, inverse_yy_ = 0.0F;
};

}  // namespace rotrocc
