#pragma once

#include "rotrocc/odometry_config.h"
#include "rotrocc/parameter_table.h"

namespace rotrocc {

// Sections of the parameter table, in the order of the YAML file. The configuration must outlive
// the table.

void addOdometry(OdometryConfig& config, ParameterTable& table);

}  // namespace rotrocc
