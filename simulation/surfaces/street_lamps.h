#pragma once

#include <vector>

#include <Eigen/Core>

#include "simulation/scene/scene_geometry.h"

namespace rotrocc {

/// The light of the lamps among the bodies of a scene. It passes through everything.
class StreetLamps {
 public:
  explicit StreetLamps(const SceneGeometry& scene);

  /// Light on a surface, 1 on level ground right below a lamp of 6.5 m.
  double light(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const;

 private:
  GroundGrid grid_;
  std::vector<std::vector<Eigen::Vector3d>> lamps_;  // in reach of each cell, row by row
};

}  // namespace rotrocc
