#pragma once

#include <Eigen/Core>

#include "simulation/surfaces/surface_point.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// The background at infinity: clouds, and wooded hills along the horizon.
class Sky {
 public:
  /// The textures must outlive this object.
  explicit Sky(const TextureTiles& tiles) : tiles_(tiles) {}

  /// Brightness in a direction of any length, averaged over the pixel.
  double brightness(const Eigen::Vector3d& direction, const PixelSpread& spread) const;

 private:
  double clouds(const Eigen::Vector3d& direction, const PixelSpread& spread) const;

  const TextureTiles& tiles_;
};

}  // namespace rotrocc
