#pragma once

#include <Eigen/Core>

#include "simulation/surfaces/surface_point.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Brightness of the background at infinity, clouds and wooded hills along the horizon, in a
/// direction of any length, averaged over the pixel.
double skyBrightness(const TextureTiles& tiles,
                     const Eigen::Vector3d& direction,
                     const PixelSpread& spread);

}  // namespace rotrocc
