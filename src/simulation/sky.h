#pragma once

#include <Eigen/Core>

#include "simulation/surface_point.h"
#include "simulation/texture_tiles.h"

namespace rotrocc {

/// What lies infinitely far away: clouds, and wooded hills along the horizon.
class Sky {
 public:
  /// The textures must outlive it.
  explicit Sky(const TextureTiles& tiles) : tiles_(tiles) {}

  /// The brightness in a direction of any length, as the mean over the pixel.
  double brightness(const Eigen::Vector3d& direction, const PixelSpread& spread) const;

 private:
  double clouds(const Eigen::Vector3d& direction, const PixelSpread& spread) const;

  const TextureTiles& tiles_;
};

}  // namespace rotrocc
