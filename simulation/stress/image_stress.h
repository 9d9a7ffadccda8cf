#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace rotrocc {

/// What makes the images of a sequence worse, in the order in which light, sensor and link do it.
struct ImageStress {
  double plain_share = 0.0;   ///< of the image, from its left border on, that has no texture
  double drop_share = 0.0;    ///< of the image that drops on the lenses cover
  double gain_step = 1.0;     ///< factor between the gains of both cameras before and after a step
  double contrast = 1.0;      ///< share of the contrast that is left, as in fog
  double right_gain = 1.0;    ///< factor of all grey levels of the right images
  double right_offset = 0.0;  ///< [grey levels] added to them after that
  double noise_sigma = 0.0;   ///< [grey levels], independent for each pixel
  int jpeg_quality = 0;       ///< 1 to 100; 0: not compressed
  std::uint64_t seed = 1;

  /// Throws std::invalid_argument, naming the first value out of range.
  void check() const;
};

/// The stressed image of a CV_8UC1 image. The same seed gives the same bytes.
cv::Mat stressed(const cv::Mat& image, const ImageStress& stress, int pair, bool right);

}  // namespace rotrocc
