#pragma once

#include <cstdint>
#include <vector>

#include "simulation/drives/drive.h"
#include "simulation/scene/body.h"
#include "simulation/scene/lamps.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Inside of the walls of the hall; the flight starts at the origin.
struct HallWalls {
  static constexpr double kLeft_m = -8.0;
  static constexpr double kRight_m = 8.0;
  static constexpr double kBack_m = -3.0;
  static constexpr double kFront_m = 21.0;
  static constexpr double kHeight_m = 6.0;
};

/// Where the light of the hall comes from.
std::vector<Lamp> hallLamps();

/// Walls, lamps, ceiling, pillars, doors, and what stands and hangs in the hall out of the way of
/// the drive.
std::vector<Body> furnishHall(const Drive& drive, const TextureTiles& tiles, std::uint64_t seed);

}  // namespace rotrocc
