#pragma once

#include "simulation/drives/scenario.h"

namespace rotrocc {

/// A small rover on a gravel track through uneven meadows, with a low camera that looks down a
/// little: 0.7 m/s, roll and pitch of up to 3 degrees.
Scenario field(std::uint64_t seed);

}  // namespace rotrocc
