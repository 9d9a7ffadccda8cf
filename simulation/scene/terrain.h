#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/shape.h"
#include "simulation/street/path.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {

/// A grid of square cells over the ground plane (x, z).
struct GroundGrid {
  double cell_m;
  double cells_per_m;      ///< 1 / cell_m
  Eigen::Vector2d origin;  ///< the corner with least x and z
  int columns;             ///< cells along x
  int rows;                ///< cells along z

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

  /// Height (y) of the ground, level beyond the grid, and its normal, upwards.
  double height(double x, double z) const;
  Eigen::Vector3d normal(double x, double z) const;

  /// The pose of a body upright on the ground at (x, z), its z axis along `ahead`, which is level.
  Eigen::Isometry3d standing(const Eigen::Vector2d& at, const Eigen::Vector3d& ahead) const {
    return placed(at, Eigen::Vector3d::UnitY(), ahead);
  }

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
  struct Place {
    const Patch& patch;
    double u, v;
  };
  Place placeOf(double x, double z) const;
  const Patch& patch(int column, int row) const {
    return patches_[static_cast<std::size_t>(row) * grid_.columns + column];
  }

  Eigen::Isometry3d placed(const Eigen::Vector2d& at,
                           const Eigen::Vector3d& down,
                           const Eigen::Vector3d& ahead) const;

  GroundGrid grid_;
  std::vector<Patch> patches_;  // of the cells, row by row
};

/// A ground that lies 1.65 m below the path of the camera, which goes on `beyond_m` before its
/// start and after its end, and below the streets. Where the camera revisits a place at another
/// height, as recorded poses drift, it is the mean of both, but always below the camera.
Terrain groundBelow(const Path& path, double beyond_m, const std::vector<Path>& streets);

}  // namespace rotrocc
