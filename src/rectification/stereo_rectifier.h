#pragma once

#include <algorithm>
#include <memory>
#include <optional>

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "rectification/image_resampler.h"
#include "rectification/stereo_calibration.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Rectifies the images of a stereo pair, left and right in parallel, without allocating memory.
class StereoRectifier {
 public:
  /// With one thread, the left image is rectified before the right one; more than two are of no
  /// use.
  explicit StereoRectifier(int threads = 2) : workers_(std::min(threads, 2)) {}

  /// Keeps the maps. `threads` as above.
  void setThreads(int threads) { workers_ = Workers(std::min(threads, 2)); }

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
  Workers workers_;
};

}  // namespace rotrocc
