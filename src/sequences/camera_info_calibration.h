#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// The message of one camera, without a header. `shift_px`: P[3].
sensor_msgs::CameraInfo toCameraInfo(const RawCamera& raw,
                                     const StereoCamera& rectified,
                                     double cx,
                                     double shift_px);

/// A file of camera_calibration. Throws std::runtime_error with path, key and problem.
sensor_msgs::CameraInfo readCameraInfo(const std::string& path);

}  // namespace rotrocc
