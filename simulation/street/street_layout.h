#pragma once

#include <vector>

#include "simulation/scene/body.h"
#include "simulation/scene/terrain.h"
#include "simulation/scene/world.h"
#include "simulation/street/street_map.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// All bodies beside the streets of `plan`: houses, parked cars, trees, lamps etc., by its style,
/// on the ground and never on a street. The textures must outlive the bodies.
std::vector<Body> layOutStreets(const WorldPlan& plan,
                                const StreetMap& streets,
                                const Terrain& terrain,
                                const TextureTiles& tiles);

}  // namespace rotrocc
