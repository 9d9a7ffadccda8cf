#pragma once

#include "simulation/counter_random.h"
#include "simulation/scene/body.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// A tree: a trunk under a crown of a few leafy balls with gaps between the leaves. Its origin is
/// at the base of the trunk. The textures must outlive it.
Body makeTree(const TextureTiles& tiles, RandomStream& random);

/// A bush of a few leafy balls, up to a metre high.
Body makeBush(const TextureTiles& tiles, RandomStream& random);

/// A hedge along x, `length_m` long, with its origin in the centre.
Body makeHedge(double length_m, const TextureTiles& tiles, RandomStream& random);

/// A tall forest tree without fine detail.
Body makeForestTree(const TextureTiles& tiles, RandomStream& random);

}  // namespace rotrocc
