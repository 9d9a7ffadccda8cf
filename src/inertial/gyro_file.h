#pragma once

#include <string>
#include <vector>

#include "inertial/gyro_history.h"

namespace rotrocc {

/// Reads a table in the layout of data.csv of the EuRoC data set: timestamp [ns], three angular
/// velocities [rad/s], and more that is ignored, as the accelerations. Throws std::runtime_error
/// with the line on anything else.
std::vector<GyroSample> readGyroFile(const std::string& path);

/// Writes that layout, with accelerations of zero. Throws std::runtime_error if the file cannot be
/// written.
void writeGyroFile(const std::string& path, const std::vector<GyroSample>& samples);

}  // namespace rotrocc
