#pragma once

#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <Eigen/Geometry>

#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// Reads the calibration of a stereo camera:
///   left.yaml, right.yaml    files of camera_calibration, which have the rectification
///   camchain.yaml            a file of Kalibr: cam0 is the left camera, cam1 the right one; they
///                            are rectified as chooseRectification() says
/// `baseline_m` > 0 replaces that of camera_calibration. Throws std::runtime_error with path, key,
/// value and problem.
StereoCalibration readStereoCalibration(const std::vector<std::string>& paths,
                                        double baseline_m = 0.0);

/// A file of camera_calibration. Throws std::runtime_error with path, key and problem.
sensor_msgs::CameraInfo readCameraInfo(const std::string& path);

/// A file sensor.yaml of a camera in the ASL format. Throws std::runtime_error with path, key,
/// value and problem.
struct AslCamera {
  RawCamera camera;
  Eigen::Isometry3d T_body_camera;
};
AslCamera readAslCamera(const std::string& path);

/// T_BS of the sensor.yaml of any sensor: maps its points to those of the body. Identity if the
/// file does not exist. Throws as readAslCamera().
Eigen::Isometry3d readAslPose(const std::string& path);

}  // namespace rotrocc
