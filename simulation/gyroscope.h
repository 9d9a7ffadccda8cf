#pragma once

#include <cstdint>
#include <vector>

#include "inertial/gyro_sample.h"
#include "simulation/drives/drive.h"

namespace rotrocc {

/// A gyroscope as drones and cameras have it, with the figures of the ADIS16448 in the EuRoC data
/// set's sensor.yaml.
struct GyroFigures {
  double rate_hz = 200.0;
  double noise_density = 1.6968e-4;      ///< [rad/s/sqrt(Hz)], white
  double bias_walk = 1.9393e-5;          ///< [rad/s^2/sqrt(Hz)]
  double bias_sigma_rps = M_PI / 180.0;  ///< of the bias at the start, for each axis
};

/// Samples in axes of the camera, from before `first_ns` until after `last_ns`, at stamps that are
/// not those of frames.
std::vector<GyroSample> simulateGyroscope(const Drive& drive,
                                          std::int64_t first_ns,
                                          std::int64_t last_ns,
                                          std::uint64_t seed,
                                          const GyroFigures& figures = {});

}  // namespace rotrocc
