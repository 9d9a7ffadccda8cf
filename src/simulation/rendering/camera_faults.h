#pragma once

#include <cstdint>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Faults of a stereo rig that are not in its calibration file.
struct CameraFaults {
  double disparity_bias_px = 0.0;                                ///< added to all disparities
  Eigen::Vector3d right_rotation_rad = Eigen::Vector3d::Zero();  ///< of the right camera: about its
                                                                 ///< z (roll), x (pitch), y (yaw)
  double time_skew_s = 0.0;                                      ///< delay of the right camera
  double noise_sigma = 2.0;     ///< [grey levels], Gaussian, independent for each pixel
  double vignetting = 0.15;     ///< relative loss of light in the corners
  double exposure_jumps = 0.0;  ///< gain jumps every 12 frames, to 1 + this at most, or its inverse
  double motion_blur_s = 0.0;   ///< exposure time, around the stamp

  /// Throws std::invalid_argument, naming the first value out of range.
  void check() const;

  /// True T_left_right of the rig.
  Eigen::Isometry3d rightCamera(const StereoCamera& camera) const;
};

/// Identifies camera and frame: their noise differs.
struct ImageNumber {
  int frame;
  bool right;
};

/// Converts brightness (CV_32FC1, 1 is white) to a CV_8UC1 image with vignetting, exposure and
/// noise. The same seed gives the same bytes for any number of threads.
cv::Mat develop(const cv::Mat& brightness,
                const CameraFaults& faults,
                const ImageNumber& number,
                std::uint64_t seed);

}  // namespace rotrocc
