#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "rectification/stereo_calibration.h"

namespace rotrocc {

struct StereoFileOptions {
  double baseline_m = 0.0;  ///< > 0: replaces that of files with projection matrices
  std::function<cv::Size()> sizeOfImages = {};  ///< for files that lack it
};

/// Reads the calibration of a stereo camera, the left camera's file first:
///   left.yaml right.yaml              of camera_calibration, or printed by rostopic echo
///   camchain.yaml                     of Kalibr or OpenVINS: cam0 is the left camera
///   left.yaml right.yaml              of ASL (sensor.yaml) or Kimera
///   settings.yaml                     of ORB-SLAM: LEFT.K ...; Camera.fx and Camera.bf;
///                                     Camera1.fx and Stereo.b or Stereo.T_c1_c2
///   intrinsics.yml extrinsics.yml     of OpenCV's sample stereo_calib
/// Those without a rectification are rectified as chooseRectification() says. Throws
/// std::runtime_error with path, key, value and problem, or with what can be read.
StereoCalibration readStereoCalibration(const std::vector<std::string>& paths,
                                        const StereoFileOptions& options = {});

/// A file of camera_calibration, or camera_info as rostopic prints it. Throws std::runtime_error
/// with path, key and problem.
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
