#pragma once

#include "simulation/counter_random.h"
#include "simulation/scene/body.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Small objects beside a street. Each stands on its origin; x points along the street, and fronts
/// face -z. The textures must outlive them.

/// A lamp post whose arm reaches along -z.
Body makeLamp();

/// A traffic sign on a post: round or square.
Body makeSign(const TextureTiles& tiles, RandomStream& random);

/// Two lights on a post.
Body makeTrafficLight();

/// A kerb stone along x.
Body makeKerb(double length_m, const TextureTiles& tiles, RandomStream& random);

/// A rail on a post, along x.
Body makeGuardRail(double length_m, const TextureTiles& tiles);

/// A litter bin.
Body makeBin(RandomStream& random);

/// A sign over the whole street, on two posts that stand `half_width_m` to both sides (along x).
Body makeGantry(double half_width_m, const TextureTiles& tiles, RandomStream& random);

}  // namespace rotrocc
