#pragma once

#include <string>

#include <Eigen/Core>

#include "inertial/gyro_predictor.h"

namespace rotrocc {

/// State of the gyroscope, for diagnostics and status.
struct GyroReport {
  std::string topic;
  std::string why_not_used;  ///< for the last pair, in one sentence; empty if it was
  GyroPredictor::Counts counts;
  Eigen::Vector3d bias_rps = Eigen::Vector3d::Zero();
  double bias_sigma_rps = 0.0;  ///< of the three axes together
};

}  // namespace rotrocc
