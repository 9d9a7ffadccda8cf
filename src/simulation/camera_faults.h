#pragma once

#include <cstdint>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What is wrong with a stereo rig. Its calibration file knows nothing of it.
struct CameraFaults {
  double disparity_bias_px = 0.0;  ///< measured disparities are too large by this
  Eigen::Vector3d right_rotation_rad = Eigen::Vector3d::Zero();  ///< of the right camera: about its
                                                                 ///< z (roll), x (pitch), y (yaw)
  double time_skew_s = 0.0;     ///< the right camera is exposed so much later
  double noise_sigma = 2.0;     ///< [grey levels], Gaussian, independent for each pixel
  double vignetting = 0.15;     ///< share of the light that is lost in the corners
  double exposure_jumps = 0.0;  ///< gain jumps every 12 frames, to 1 + this at most, or its inverse
  double motion_blur_s = 0.0;   ///< exposure time, around the stamp

  /// Throws std::invalid_argument that names the first value out of its range.
  void check() const;

  /// T_left_right of the rig as it is.
  Eigen::Isometry3d rightCamera(const StereoCamera& camera) const;
};

/// Which of the two images, and which frame: their noise differs.
struct ImageNumber {
  int frame;
  bool right;
};

/// The CV_8UC1 image that a camera makes of brightness (CV_32FC1, 1 is white) with vignetting,
/// exposure and noise. The same seed gives the same bytes, however many threads there are.
cv::Mat develop(const cv::Mat& brightness,
                const CameraFaults& faults,
                const ImageNumber& number,
                std::uint64_t seed);

}  // namespace rotrocc
