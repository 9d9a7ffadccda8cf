#pragma once

#include "simulation/drives/scenario.h"

namespace rotrocc {

/// Scenarios under other conditions than a fine day's.

/// A town at night: street lamps, head lamps, a long exposure at high gain.
Scenario atNight(Scenario scenario);

/// Rain: drops on the lenses and in the air, mist, a wet road, no sun.
Scenario inRain(Scenario scenario);

}  // namespace rotrocc
