#pragma once

#include "simulation/counter_random.h"
#include "simulation/scene/body.h"

namespace rotrocc {

/// A car of random size and paint, or a delivery van: body, cabin with windows, wheels, lights. It
/// heads along z; its origin is on the ground below its centre. `lit`: with its lights on at night.
Body makeCar(RandomStream& random, bool lit = false);

}  // namespace rotrocc
