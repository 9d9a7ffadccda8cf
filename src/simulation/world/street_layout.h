#pragma once

#include <vector>

#include "simulation/world/body.h"
#include "simulation/world/street_map.h"
#include "simulation/world/terrain.h"
#include "simulation/world/texture_tiles.h"
#include "simulation/world/world.h"

namespace rotrocc {

/// All bodies beside the streets of `plan`: houses, parked cars, trees, lamps etc., by its style,
/// on the ground and never on a street. The textures must outlive the bodies.
std::vector<Body> layOutStreets(const WorldPlan& plan,
                                const StreetMap& streets,
                                const Terrain& terrain,
                                const TextureTiles& tiles);

}  // namespace rotrocc
