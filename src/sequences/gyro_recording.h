#pragma once

#include <vector>

#include <Eigen/Core>

#include "inertial/gyro_sample.h"

namespace rotrocc {

struct GyroRecording {
  std::vector<GyroSample> samples;
  Eigen::Matrix3d R_camera_gyro = Eigen::Matrix3d::Identity();
};

}  // namespace rotrocc
