#pragma once

#include "simulation/surfaces/coverage.h"
#include "simulation/surfaces/surface_point.h"

namespace rotrocc {

/// Reflectance of a surface of square tiles, of which one looks as the other.
inline double tiledReflectance(const TexturePoint& point) {
  constexpr double kTile_m = 0.4;
  double light = 0.0;
  for (const int axis : {0, 1}) {
    light +=
        coveragePeriodic(kTile_m, 0.5 * kTile_m, point.at[axis], std::max(point.width(axis), 1e-4));
  }
  return 0.15 + 0.3 * light;
}

}  // namespace rotrocc
