#pragma once

#include "simulation/counter_random.h"
#include "simulation/scene/body.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Things in a meadow. The textures must outlive them.

/// A stone, half sunk, of up to half a metre.
Body makeStone(const TextureTiles& tiles, RandomStream& random);

/// Two posts with two rails between, along x; its origin is in the middle.
Body makeFence(double length_m, const TextureTiles& tiles, RandomStream& random);

}  // namespace rotrocc
