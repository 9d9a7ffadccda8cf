#pragma once

#include <cstdint>

#include "simulation/drives/scenario.h"

namespace rotrocc {

/// A multicopter in a closed hall.
Scenario hall(std::uint64_t seed);

}  // namespace rotrocc
