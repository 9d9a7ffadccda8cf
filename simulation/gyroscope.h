#pragma once

#include <cstdint>
#include <vector>

#include "inertial/gyro_sample.h"
#include "simulation/drives/drive.h"

namespace rotrocc {

/// A gyroscope as drones and cameras have it, at 200 Hz: samples in axes of the camera, from before
/// `first_ns` until after `last_ns`, at stamps that are not those of frames.
std::vector<GyroSample> simulateGyroscope(const Drive& drive,
                                          std::int64_t first_ns,
                                          std::int64_t last_ns,
                                          std::uint64_t seed);

}  // namespace rotrocc
