#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "simulation/surfaces/surface_point.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// Direction to the sun, of unit length: behind the viewer at the start, to the left.
inline const Eigen::Vector3d& directionToSun() {
  static const Eigen::Vector3d kDirection = Eigen::Vector3d(-0.45, -0.95, -0.62).normalized();
  return kDirection;
}

/// On a white surface with this normal (y points down), of which a share `sunlit` sees the sun.
inline double daylight(const Eigen::Vector3d& normal, double sunlit) {
  const double sky = 0.36 * (0.8 - 0.2 * normal.y());
  return sky + 0.8 * sunlit * std::max(0.0, normal.dot(directionToSun()));
}

/// Clouds, and wooded hills along the horizon, in a direction, averaged over the pixel.
double skyBrightness(const TextureTiles& tiles,
                     const Eigen::Vector3d& direction,
                     const PixelSpread& spread);

}  // namespace rotrocc
