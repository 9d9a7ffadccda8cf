#pragma once

#include "simulation/drives/scenario.h"

namespace rotrocc {

/// A multicopter in a hall of 16 m x 24 m: take-off, a turn of 100 deg/s on the spot, a wall at
/// half a metre.
Scenario hall(std::uint64_t seed);

}  // namespace rotrocc
