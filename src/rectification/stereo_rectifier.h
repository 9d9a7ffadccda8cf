#pragma once

#include <algorithm>

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
  /// use. Throws std::invalid_argument on a calibration that is not one, see RawCamera::check(),
  /// and of images larger than 32000 px.
  explicit StereoRectifier(const StereoCalibration& calibration, int threads = 2);

  /// Keeps the maps. `threads` as above.
  void setThreads(int threads) { workers_ = Workers(std::min(threads, 2)); }

  /// Of the rectified images.
  const StereoCamera& camera() const { return camera_; }

  /// The rectified images are valid until the next call. Pixels that a camera does not see repeat
  /// the border of its image, which has fewer corners than a black edge. Throws
  /// std::invalid_argument if the images are not CV_8UC1 of the size of the raw cameras.
  StereoPair rectify(const StereoPair& raw);

 private:
  struct Side {
    ImageResampler resampler;
    cv::Mat rectified;
  };

  static Side makeSide(const char* name,
                       const RawCamera& raw,
                       const StereoCamera& camera,
                       double cx);

  StereoCamera camera_;
  Side left_;
  Side right_;
  Workers workers_;
};

}  // namespace rotrocc
