#pragma once

#include "simulation/counter_random.h"
#include "simulation/scene/body.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// What stands beside a street, each on its origin. The textures must outlive it.

/// A car of random size and paint, or a delivery van: body, cabin with windows, wheels, lights. It
/// heads along z; its origin is on the ground below its centre. `lit`: with its lights on at night.
Body makeCar(RandomStream& random, bool lit = false);

/// Size of a house on the ground [m]: `width` is its front, the street is at its -z side.
struct HouseSize {
  double width;
  double depth;
};

/// A random house of two to four floors with windows, a door or a shop, and a roof. Its origin is
/// in the centre of its footprint.
Body makeHouse(const HouseSize& size, const TextureTiles& tiles, RandomStream& random);

/// Of the small objects, x points along the street, and fronts face -z.

/// A lamp post whose arm reaches along -z.
Body makeLamp();

/// A traffic sign on a post: round or square.
Body makeSign(const TextureTiles& tiles, RandomStream& random);

/// A kerb stone along x.
Body makeKerb(double length_m, const TextureTiles& tiles, RandomStream& random);

/// A rail on a post, along x.
Body makeGuardRail(double length_m, const TextureTiles& tiles);

/// A litter bin.
Body makeBin(RandomStream& random);

/// A sign over the whole street, on two posts that stand `half_width_m` to both sides (along x).
Body makeGantry(double half_width_m, const TextureTiles& tiles, RandomStream& random);

/// A tree: a trunk under a crown of a few leafy balls with gaps between the leaves. Its origin is
/// at the base of the trunk.
Body makeTree(const TextureTiles& tiles, RandomStream& random);

/// A hedge along x, `length_m` long, with its origin in the centre.
Body makeHedge(double length_m, const TextureTiles& tiles, RandomStream& random);

/// A tall forest tree without fine detail.
Body makeForestTree(const TextureTiles& tiles, RandomStream& random);

}  // namespace rotrocc
