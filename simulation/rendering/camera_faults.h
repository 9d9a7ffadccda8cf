#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "rotrocc/stereo_camera.h"
#include "simulation/rendering/sensor.h"

namespace rotrocc {

/// Faults of a stereo rig that are not in its calibration file.
struct CameraFaults {
  double disparity_bias_px = 0.0;                                ///< added to all disparities
  Eigen::Vector3d right_rotation_rad = Eigen::Vector3d::Zero();  ///< of the right camera: about its
                                                                 ///< z (roll), x (pitch), y (yaw)
  double row_offset_px = 0.0;   ///< of the right image: what it shows is this much lower
  double time_skew_s = 0.0;     ///< delay of the right camera
  double exposure_jumps = 0.0;  ///< gain jumps every 12 frames, to 1 + this at most, or its inverse
  double motion_blur_s = 0.0;   ///< exposure time, around the stamp
  Sensor sensor;

  /// Throws std::invalid_argument, naming the first value out of range.
  void check() const;

  /// True T_left_right of the rig.
  Eigen::Isometry3d rightCamera(const StereoCamera& camera) const;
};

/// Gain of both images of a frame by the exposure jumps.
double jumpGain(const CameraFaults& faults, int frame, std::uint64_t seed);

}  // namespace rotrocc
