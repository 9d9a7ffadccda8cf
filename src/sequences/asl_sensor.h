#pragma once

#include <string>

#include <Eigen/Geometry>

#include "rectification/stereo_calibration.h"

namespace rotrocc {

/// Files sensor.yaml of the ASL format, as those of EuRoC. All throw std::runtime_error with path,
/// key, value and problem.

struct AslCamera {
  RawCamera camera;
  Eigen::Isometry3d T_body_camera;
};
AslCamera readAslCamera(const std::string& path);

/// T_BS of any sensor: maps its points to those of the body. Identity if the file does not exist.
Eigen::Isometry3d readAslPose(const std::string& path);

}  // namespace rotrocc
