#pragma once

#include <cstdint>
#include <vector>

#include "simulation/scene/body.h"
#include "simulation/scene/terrain.h"

namespace rotrocc {

/// The ground and the bodies on it, in a grid for fast ray casting.
class SceneGeometry {
 public:
  SceneGeometry(Terrain terrain, std::vector<Body> bodies);

  const Terrain& terrain() const { return terrain_; }
  const std::vector<Body>& bodies() const { return bodies_; }
  std::vector<Body>& bodies() { return bodies_; }  ///< to light them, not to move them

  /// The bodies in or next to the cell of a place on the ground.
  const std::vector<std::int32_t>& bodiesAround(double x, double z) const;

  /// Whether the ground or a body blocks a ray in `range`, within the grid of the ground. A pixel
  /// is `pixel_m` wide at distance 1. The ray must start above the ground.
  bool isBlocked(const Ray& ray, const RayRange& range, double pixel_m) const;

  /// First hit with the ground; false if there is none.
  bool traceGround(const Ray& ray, const RayRange& range, double& distance) const;

 private:
  struct Cell {
    double top = 0.0;  // least y of the ground and the bodies
    std::vector<std::int32_t> bodies;
  };

  void enter(const Body& body, std::int32_t index);
  const Cell& cell(int column, int row) const {
    return cells_[static_cast<std::size_t>(row) * terrain_.grid().columns + column];
  }

  Terrain terrain_;
  std::vector<Body> bodies_;
  std::vector<Cell> cells_;
  double top_ = 0.0;         // of all cells
  double ground_top_ = 0.0;  // of the ground
};

}  // namespace rotrocc
