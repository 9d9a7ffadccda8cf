#pragma once

#include "simulation/body.h"
#include "simulation/counter_random.h"
#include "simulation/texture_tiles.h"

namespace rotrocc {

/// The size of a house on the ground [m]: its front is `width`, the street is at its -z side.
struct HouseSize {
  double width;
  double depth;
};

/// A house of two to four floors with windows, a door or a shop, and a roof; no two are alike. Its
/// origin is in the middle of its footprint. The textures must outlive it.
Body makeHouse(const HouseSize& size, const TextureTiles& tiles, RandomStream& random);

}  // namespace rotrocc
