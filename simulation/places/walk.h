#pragma once

#include <cstdint>

#include "simulation/drives/scenario.h"

namespace rotrocc {

/// On foot through a lane between houses, up a stair and into a side lane.
Scenario walk(std::uint64_t seed);

}  // namespace rotrocc
