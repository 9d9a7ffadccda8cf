#pragma once

#include <Eigen/Core>

#include "simulation/scene/scene_geometry.h"

namespace rotrocc {

/// The light that falls on the surfaces of a world.
class Light {
 public:
  virtual ~Light() = default;

  /// Illumination of a surface of which `share` of its direct light is seen, from 0 to 1. Times the
  /// reflectance it is the brightness, of which 1 is white.
  virtual double illumination(const Eigen::Vector3d& position,
                              const Eigen::Vector3d& normal,
                              double share) const = 0;

  /// Share of the direct light that reaches a place among bodies, from 0 to 1.
  virtual double reaching(const SceneGeometry& scene, const Eigen::Vector3d& position) const = 0;
};

}  // namespace rotrocc
