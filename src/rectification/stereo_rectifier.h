#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "rectification/stereo_calibration.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Makes images whose pixels are at given places of another one, by cubic convolution (Catmull-Rom)
/// over 4 x 4 pixels. Bilinear interpolation blurs by the fraction of the place, which differs from
/// pixel to pixel and disturbs tracking: errors of the odometry are a tenth larger with it.
///
/// Not cv::remap(): its INTER_CUBIC has steps of 1/32 px and another kernel. By the lenses of
/// EuRoC, patches of 9 x 9 px of a pattern with periods of 4 to 30 px are off by 0.023 px (rms)
/// after it, by 0.009 px after this; an image of 752x480 px takes 4.3 instead of 2.8 ms.
/// INTER_LANCZOS4 is off by 0.010 px, but takes 12 ms.
class ImageResampler {
 public:
  /// `source` is the size of the images that places are in, `size` that of the results. All places
  /// are set to the first pixel.
  ImageResampler(const cv::Size& source, const cv::Size& size);

  /// The place of a pixel of the results, rounded to 1/256 px. Outside of the source image it is
  /// that of the nearest border.
  void setPlace(int x, int y, const cv::Point2d& place);

  /// Fills `result`, CV_8UC1 of the size of the results. `image` is CV_8UC1 of the source size.
  void resample(const cv::Mat& image, cv::Mat& result);

 private:
  static constexpr int kTaps = 4;
  static constexpr int kPhases = 256;
  /// Of one phase, once for each direction, as the registers of pixelAt() need them.
  struct Weights {
    std::array<std::int32_t, kTaps> across;
    std::array<std::int16_t, 2 * kTaps> down_0_2;  // those of rows 0 and 2 in turn
    std::array<std::int16_t, 2 * kTaps> down_1_3;
  };

  struct Place {
    std::int16_t column = 0;  // of the pixel left above
    std::int16_t row = 0;
    std::uint8_t column_phase = 0;
    std::uint8_t row_phase = 0;
  };

  static std::array<Weights, kPhases> weightTable();
  std::uint8_t pixelAt(const Place& place) const;

  cv::Size source_;
  cv::Size size_;
  std::vector<Place> places_;
  cv::Mat framed_;  // the source image and copies of its border, which pixels there need
  std::array<Weights, kPhases> weights_ = weightTable();
};

/// Rectifies the images of a stereo pair, left and right in parallel, into memory that it reuses.
class StereoRectifier {
 public:
  /// By the calibration of this pair, whose cameras are valid: the maps are rebuilt when it is
  /// another object. The rectified images are valid until the next call. Masks are rectified, too:
  /// a pixel is masked if a masked one contributes to it. Pixels that a camera does not see repeat
  /// the border of its image, which has fewer corners than a black edge. Images and masks are
  /// CV_8UC1 of the size of the raw cameras.
  StereoPair rectify(const StereoPair& raw,
                     const std::shared_ptr<const StereoCalibration>& calibration);

 private:
  struct Side {
    ImageResampler resampler;
    cv::Mat rectified;
    cv::Mat raw_mask = {};
    cv::Mat mask = {};  // of raw_mask
  };

  static Side makeSide(const RawCamera& raw, const StereoCamera& camera, double cx);
  static const cv::Mat& rectifyMask(const cv::Mat& raw_mask, Side& side);

  std::optional<Side> left_, right_;
  std::shared_ptr<const StereoCalibration> calibration_;  // that the maps are made of
};

}  // namespace rotrocc
