#pragma once

#include <cstdint>
#include <vector>

#include "inertial/gyro_history.h"
#include "simulation/drives/drive.h"

namespace rotrocc {

/// A gyroscope of 200 Hz in axes of the camera, from before `first_ns` until after `last_ns`.
std::vector<GyroSample> simulateGyroscope(const Drive& drive,
                                          std::int64_t first_ns,
                                          std::int64_t last_ns,
                                          std::uint64_t seed);

}  // namespace rotrocc
