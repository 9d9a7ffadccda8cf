#pragma once

#include <opencv2/core.hpp>

#include "common/workers.h"
#include "rectification/stereo_calibration.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Rectifies the images of a stereo pair, left and right in parallel, without allocating memory.
class StereoRectifier {
 public:
  /// Throws std::invalid_argument on a calibration that is not one, see RawCamera::check().
  explicit StereoRectifier(const StereoCalibration& calibration);

  /// Of the rectified images.
  const StereoCamera& camera() const { return camera_; }

  /// The rectified images are valid until the next call. Pixels that a camera does not see repeat
  /// the border of its image, which has fewer corners than a black edge. Throws
  /// std::invalid_argument if the images are not CV_8UC1 of the size of the raw cameras.
  StereoPair rectify(const StereoPair& raw);

 private:
  /// From the pixels of a rectified image to those of the raw one.
  struct Side {
    cv::Size raw_size;
    cv::Mat map;        // CV_16SC2: whole pixels
    cv::Mat fractions;  // CV_16UC1: index in OpenCV's table of 1/32 px
    cv::Mat rectified;
  };

  static Side makeSide(const char* name,
                       const RawCamera& raw,
                       const StereoCamera& camera,
                       double cx);

  StereoCamera camera_;
  Side left_;
  Side right_;
  Workers workers_{2};
};

}  // namespace rotrocc
