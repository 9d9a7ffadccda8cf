#pragma once

#include <vector>

#include "simulation/scene/terrain.h"
#include "simulation/street/path.h"

namespace rotrocc {

/// The y coordinate at each corner of a grid, row by row, of a ground that lies `below_m` below the
/// path of the camera, which goes on `beyond_m` before its start and after its end, and below other
/// paths. Where the camera revisits a place at another height, as recorded poses drift, it is the
/// mean of both, but always below the camera.
std::vector<double> groundBelow(const GroundGrid& grid,
                                const Path& path,
                                double beyond_m,
                                const std::vector<Path>& others,
                                double below_m);

}  // namespace rotrocc
