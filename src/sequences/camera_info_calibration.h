#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>

#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// What K, D, R and P of two messages describe, with binning and region of interest as in
/// image_geometry. `baseline_m` > 0 replaces the baseline from P[3]. Throws InputError with the
/// value and a remedy if P is not that of a rectified pair (see toStereoCamera()), K is not a
/// pinhole camera, or D or R are invalid.
StereoCalibration toStereoCalibration(const sensor_msgs::CameraInfo& left,
                                      const sensor_msgs::CameraInfo& right,
                                      double baseline_m = 0.0);

/// Whether K, D and R describe images that are not rectified.
bool describesRawImages(const sensor_msgs::CameraInfo& info);

/// The message of one camera, without a header. `shift_px`: P[3].
sensor_msgs::CameraInfo toCameraInfo(const RawCamera& raw,
                                     const StereoCamera& rectified,
                                     double cx,
                                     double shift_px);

/// A file of camera_calibration. Throws std::runtime_error with path, key and problem.
sensor_msgs::CameraInfo readCameraInfo(const std::string& path);

}  // namespace rotrocc
