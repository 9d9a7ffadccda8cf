#pragma once

#include <string>
#include <vector>

#include "inertial/gyro_history.h"

namespace rotrocc {

/// Reads a table in the layout of data.csv of the EuRoC data set: timestamp [ns], three angular
/// velocities [rad/s], and more that is ignored, as the accelerations. Throws std::runtime_error
/// with the line on anything else.
std::vector<GyroSample> readGyroFile(const std::string& path);

}  // namespace rotrocc
