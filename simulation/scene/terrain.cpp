#include "simulation/scene/terrain.h"

#include <algorithm>
#include <cmath>

namespace rotrocc {
Terrain::Terrain(const GroundGrid& grid, const std::vector<double>& heights) : grid_(grid) {
  const int corners = grid.columns + 1;  // in a row
  for (int row = 0; row < grid.rows; ++row) {
    const double* near = heights.data() + static_cast<std::size_t>(row) * corners;
    const double* far = near + corners;
    for (int column = 0; column < grid.columns; ++column, ++near, ++far) {
      patches_.push_back({near[0],
                          near[1] - near[0],
                          far[0] - near[0],
                          far[1] - near[1] - far[0] + near[0],
                          std::min({near[0], near[1], far[0], far[1]})});
    }
  }
}

Terrain::Place Terrain::placeOf(double x, double z) const {
  const int column = std::clamp(grid_.column(x), 0, grid_.columns - 1);
  const int row = std::clamp(grid_.row(z), 0, grid_.rows - 1);
  return {patch(column, row),
          std::clamp((x - grid_.origin.x()) * grid_.cells_per_m - column, 0.0, 1.0),
          std::clamp((z - grid_.origin.y()) * grid_.cells_per_m - row, 0.0, 1.0)};
}

double Terrain::height(double x, double z) const {
  const auto [p, u, v] = placeOf(x, z);
  return p.a + p.b * u + p.c * v + p.d * u * v;
}

Eigen::Vector3d Terrain::normal(double x, double z) const {
  const auto [p, u, v] = placeOf(x, z);
  return Eigen::Vector3d(
             (p.b + p.d * v) * grid_.cells_per_m, -1.0, (p.c + p.d * u) * grid_.cells_per_m)
      .normalized();
}

Eigen::Isometry3d Terrain::placed(const Eigen::Vector2d& at,
                                  const Eigen::Vector3d& down,
                                  const Eigen::Vector3d& ahead) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d right = down.cross(ahead).normalized();
  pose.linear() << right, down, right.cross(down);
  pose.translation() << at.x(), height(at.x(), at.y()), at.y();
  return pose;
}

Eigen::Isometry3d Terrain::lying(const Eigen::Vector2d& at, const Eigen::Vector3d& ahead) const {
  // Mean slope: the slope at a point is discontinuous between cells.
  constexpr double kReach = 1.5;
  const double dx = height(at.x() + kReach, at.y()) - height(at.x() - kReach, at.y());
  const double dz = height(at.x(), at.y() + kReach) - height(at.x(), at.y() - kReach);
  return placed(at, Eigen::Vector3d(-dx, 2.0 * kReach, -dz).normalized(), ahead);
}

bool Terrain::intersect(
    const Ray& ray, const RayRange& range, int column, int row, double& distance) const {
  const Patch& p = patch(column, row);
  // Distances are relative to the entry into the cell, for accuracy.
  const Eigen::Vector3d start = ray.at(range.from);
  const double u = (start.x() - grid_.origin.x()) * grid_.cells_per_m - column;
  const double v = (start.z() - grid_.origin.y()) * grid_.cells_per_m - row;
  const double du = ray.direction.x() * grid_.cells_per_m;
  const double dv = ray.direction.z() * grid_.cells_per_m;
  // Height of the ray relative to the ground; positive below, as y points down.
  const double constant = start.y() - (p.a + p.b * u + p.c * v + p.d * u * v);
  const double linear = ray.direction.y() - p.b * du - p.c * dv - p.d * (u * dv + v * du);
  const double square = -p.d * du * dv;
  const double length = range.to - range.from;
  if (constant > 0.0) return false;
  if (constant + length * (linear + length * square) < 0.0) return false;
  // One root lies in the cell; this form is stable for `square` close to 0.
  const double root = std::sqrt(std::max(0.0, linear * linear - 4.0 * square * constant));
  const double t = -2.0 * constant / (linear + root);
  distance = range.from + std::clamp(t, 0.0, length);
  return true;
}

}  // namespace rotrocc
