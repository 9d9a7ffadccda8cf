#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/shape.h"
#include "simulation/street/path.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {

/// A grid of square cells over the ground plane (x, z).
struct GroundGrid {
  double cell_m = 5.0;
  double cells_per_m = 0.2;                          ///< 1 / cell_m
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< the corner with least x and z
  int columns = 0;                                   ///< cells along x
  int rows = 0;                                      ///< cells along z

  /// The grid that covers all paths with a margin of `margin_m`.
  static GroundGrid around(const std::vector<Path>& paths, double margin_m, double cell_m);

  int column(double x) const { return floorToInt((x - origin.x()) * cells_per_m); }
  int row(double z) const { return floorToInt((z - origin.y()) * cells_per_m); }
  bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
};

/// The shape of the ground: smooth hills.
class Terrain {
 public:
  /// `heights` are the y coordinates at the corners of the cells, row by row.
  Terrain(const GroundGrid& grid, const std::vector<double>& heights);

  const GroundGrid& grid() const { return grid_; }

  /// Height (y) of the ground, extrapolated level beyond the grid.
  double height(double x, double z) const;

  /// Normal of unit length, upwards.
  Eigen::Vector3d normal(double x, double z) const;

  /// The pose of a body that stands upright on the ground at (x, z) with its z axis along `ahead`
  /// (level, of unit length).
  Eigen::Isometry3d standing(const Eigen::Vector2d& at, const Eigen::Vector3d& ahead) const;

  /// The same for a body that follows the slope of the ground: cars, kerb stones.
  Eigen::Isometry3d lying(const Eigen::Vector2d& at, const Eigen::Vector3d& ahead) const;

  /// Smallest y (highest ground) of a cell.
  double top(int column, int row) const { return patch(column, row).top; }

  /// First hit of a ray with the ground of a cell; `range` is its section in that cell.
  bool intersect(
      const Ray& ray, const RayRange& range, int column, int row, double& distance) const;

 private:
  /// height = a + b u + c v + d u v over a cell, with u and v from 0 to 1.
  struct Patch {
    double a, b, c, d;
    double top;
  };
  const Patch& patch(int column, int row) const {
    return patches_[static_cast<std::size_t>(row) * grid_.columns + column];
  }

  Eigen::Isometry3d placed(const Eigen::Vector2d& at,
                           const Eigen::Vector3d& down,
                           const Eigen::Vector3d& ahead) const;

  GroundGrid grid_;
  std::vector<Patch> patches_;  // of the cells, row by row
};

}  // namespace rotrocc
