#pragma once

#include <vector>

#include "body.h"
#include "street_map.h"
#include "terrain.h"
#include "texture_tiles.h"
#include "world.h"

namespace rotrocc {

/// Everything that stands beside the streets of `plan`: houses, parked cars, trees, lamps, ... as
/// its style says, on the ground and never on a street. The textures must outlive the bodies.
std::vector<Body> layOutStreets(const WorldPlan& plan,
                                const StreetMap& streets,
                                const Terrain& terrain,
                                const TextureTiles& tiles);

}  // namespace rotrocc
