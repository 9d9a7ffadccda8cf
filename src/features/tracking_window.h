#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "kernels/kernels.h"

namespace rotrocc {

/// The window around a feature that is looked for in another image: one level of Lucas-Kanade
/// (Bouguet 2001). What all of the window is brighter there is estimated too, and has no effect on
/// where it is: cameras change their exposure. Grey levels are interpolated in steps of 1/64,
/// gradients in steps of 1/32, and summed exactly, so that results are the same with SIMD and
/// without.
class TrackingWindow {
 public:
  struct Stop {
    int max_iterations;
    double min_step_px;  ///< iterations end when a step is shorter
  };

  /// The window is a square of 2 radius + 1; the radius is at most 25 px. With `ignores_brightness`
  /// windows are compared as if they had the same mean.
  explicit TrackingWindow(int radius_px, bool ignores_brightness = true);

  /// Takes the window around `center` of `image` (CV_8UC1), as it looks when what it shows is
  /// `scale` > 0 times as large (to first order, so that a tenth more is near enough). Returns
  /// false if the centre lies outside of the image or the texture is too weak to tell where it is.
  bool take(const cv::Mat& image, const cv::Point2f& center, float scale);

  /// Moves `center` to where `image` looks like the window that was taken. Returns false, and
  /// leaves `center` where it was, if it leaves the image.
  bool find(const cv::Mat& image, const Stop& stop, cv::Point2f& center);

 private:
  Patch patchAround(const cv::Mat& image, const cv::Point2f& center, int radius, int columns);
  void copyWithEdge(const cv::Mat& image, const cv::Rect& area);
  int wholeRegisters(int count) const;
  Window window();
  void spread(float scale);
  bool invertNormalMatrix(const GradientSums& sums);
  cv::Point2f mismatch(const Patch& patch, const Window& window) const;

  const Kernels* kernels_;
  int radius_, side_;
  bool ignores_brightness_;
  int stride_;         // of the rows below: the side, rounded up to whole registers
  int sample_stride_;  // of samples_
  std::vector<std::int16_t> samples_, values_, gradient_x_, gradient_y_, mask_, spread_;
  std::vector<uchar> border_;  // a patch that hangs over the edge of the image
  cv::Point2d mean_gradient_;  // [grey levels / px]
  float inverse_xx_ = 0.0F, inverse_xy_ = 0.0F, inverse_yy_ = 0.0F;
};

}  // namespace rotrocc
