#pragma once

#include <cstdint>

#include "simulation/drives/scenario.h"

namespace rotrocc {

/// A road tunnel of equal segments, dimly lit, with oncoming cars.
Scenario tunnel(std::uint64_t seed);

}  // namespace rotrocc
