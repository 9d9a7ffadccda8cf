#pragma once

#include "simulation/body.h"
#include "simulation/counter_random.h"

namespace rotrocc {

/// A car of random size and paint, or a delivery van: body, cabin with windows, wheels, lights. It
/// heads for z; its origin is on the ground in its middle.
Body makeCar(RandomStream& random);

}  // namespace rotrocc
