#pragma once

#include "simulation/counter_random.h"
#include "simulation/scene/body.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Size of a house on the ground [m]: `width` is its front, the street is at its -z side.
struct HouseSize {
  double width;
  double depth;
};

/// A random house of two to four floors with windows, a door or a shop, and a roof. Its origin is
/// in the centre of its footprint. The textures must outlive it.
Body makeHouse(const HouseSize& size, const TextureTiles& tiles, RandomStream& random);

}  // namespace rotrocc
