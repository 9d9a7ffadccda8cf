#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace rotrocc {

/// Angular velocity [rad/s] in axes of the gyroscope.
struct GyroSample {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d rate_rps = Eigen::Vector3d::Zero();
};

}  // namespace rotrocc
