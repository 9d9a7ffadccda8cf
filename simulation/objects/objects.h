#pragma once

#include "simulation/counter_random.h"
#include "simulation/scene/body.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// What stands beside a street, random in size and look. Each has its origin on the ground, in the
/// middle of what it covers; x points along the street, and fronts face -z. The textures must
/// outlive it.

/// A car or a delivery van, which heads along z.
Body makeCar(RandomStream& random);

/// Size of a house on the ground [m]: `width` is its front.
struct HouseSize {
  double width;
  double depth;
};

/// Two to four floors with windows, a door or a shop, and a roof.
Body makeHouse(const HouseSize& size, const TextureTiles& tiles, RandomStream& random);

/// A lamp post whose arm reaches along -z.
Body makeLamp();

/// A round or square traffic sign on a post.
Body makeSign(const TextureTiles& tiles, RandomStream& random);

Body makeKerb(double length_m, const TextureTiles& tiles, RandomStream& random);
Body makeGuardRail(double length_m, const TextureTiles& tiles);
Body makeBin(RandomStream& random);

/// A sign over the whole street, on two posts that stand `half_width_m` to both sides (along x).
Body makeGantry(double half_width_m, const TextureTiles& tiles, RandomStream& random);

Body makeTree(const TextureTiles& tiles, RandomStream& random);
Body makeHedge(double length_m, const TextureTiles& tiles, RandomStream& random);

/// A tall tree without fine detail.
Body makeForestTree(const TextureTiles& tiles, RandomStream& random);

}  // namespace rotrocc
