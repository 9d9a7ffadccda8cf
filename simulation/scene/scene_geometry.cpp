#include "simulation/scene/scene_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rotrocc {
namespace {

constexpr double kContactReach_m = 0.6;  // bodies are also listed in cells within this distance

/// Traverses the cells along a ray, in order (Amanatides and Woo, 1987).
class CellWalk {
 public:
  CellWalk(const GroundGrid& grid, const Ray& ray, const RayRange& range)
      : grid_(grid), enter_(range.from) {
    const Eigen::Vector3d start = ray.at(range.from);
    index_[0] = grid.column(start.x());
    index_[1] = grid.row(start.z());
    const double direction[2] = {ray.direction.x(), ray.direction.z()};
    const double position[2] = {start.x(), start.z()};
    for (int axis = 0; axis < 2; ++axis) {
      step_[axis] = direction[axis] > 0.0 ? 1 : -1;
      const double border =
          grid.origin[axis] + grid.cell_m * (index_[axis] + (direction[axis] > 0.0 ? 1 : 0));
      const double inverse = 1.0 / direction[axis];
      next_[axis] = direction[axis] == 0.0 ? std::numeric_limits<double>::infinity()
                                           : range.from + (border - position[axis]) * inverse;
      delta_[axis] = std::abs(grid.cell_m * inverse);
    }
  }

  bool onGrid() const { return grid_.contains(index_[0], index_[1]); }
  int column() const { return index_[0]; }
  int row() const { return index_[1]; }
  double enter() const { return enter_; }
  double leave() const { return std::min(next_[0], next_[1]); }

  void advance() {
    const int axis = next_[0] < next_[1] ? 0 : 1;
    enter_ = next_[axis];
    next_[axis] += delta_[axis];
    index_[axis] += step_[axis];
  }

 private:
  const GroundGrid& grid_;
  double enter_;
  int index_[2];
  int step_[2];
  double next_[2];
  double delta_[2];
};

/// The part of `range` where a ray is below the height `top` (y points down), plus a margin.
RayRange belowHeight(const Ray& ray, const RayRange& range, double top) {
  constexpr double kMargin_m = 0.01;
  const double at_top = (top - kMargin_m - ray.origin.y()) / ray.direction.y();
  if (ray.direction.y() < 0.0) return {range.from, std::min(range.to, at_top)};
  if (ray.direction.y() > 0.0) return {std::max(range.from, at_top), range.to};
  return range;
}

/// Looks for a hit in the cells along a ray, in order, until hits(column, row, part of `range` in
/// the cell) is true. Leaves out cells that the ray passes above their top(column, row).
template <class Top, class Hits>
bool anyCell(const GroundGrid& grid, const Ray& ray, const RayRange& range, Top top, Hits hits) {
  const bool rises = ray.direction.y() < 0.0;
  for (CellWalk walk(grid, ray, range); walk.onGrid(); walk.advance()) {
    if (walk.enter() >= range.to) return false;
    const RayRange in_cell = {walk.enter(), std::min(walk.leave(), range.to)};
    const double lowest = ray.origin.y() + ray.direction.y() * (rises ? in_cell.from : in_cell.to);
    if (lowest < top(walk.column(), walk.row())) continue;
    if (hits(walk.column(), walk.row(), in_cell)) return true;
  }
  return false;
}

}  // namespace

SceneGeometry::SceneGeometry(Terrain terrain, std::vector<Body> bodies)
    : terrain_(std::move(terrain)), bodies_(std::move(bodies)) {
  const GroundGrid& grid = terrain_.grid();
  ground_top_ = terrain_.top(0, 0);
  cells_.resize(static_cast<std::size_t>(grid.columns) * grid.rows);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const double top = terrain_.top(column, row);
      cells_[static_cast<std::size_t>(row) * grid.columns + column].top = top;
      ground_top_ = std::min(ground_top_, top);
    }
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    enter(bodies_[i], static_cast<std::int32_t>(i));
  }
  top_ = ground_top_;
  for (const Cell& cell : cells_) top_ = std::min(top_, cell.top);
}

void SceneGeometry::enter(const Body& body, std::int32_t index) {
  const GroundGrid& grid = terrain_.grid();
  const Eigen::AlignedBox3d& box = body.bounds();
  const int last_column = std::min(grid.columns - 1, grid.column(box.max().x() + kContactReach_m));
  const int last_row = std::min(grid.rows - 1, grid.row(box.max().z() + kContactReach_m));
  for (int row = std::max(0, grid.row(box.min().z() - kContactReach_m)); row <= last_row; ++row) {
    for (int column = std::max(0, grid.column(box.min().x() - kContactReach_m));
         column <= last_column;
         ++column) {
      Cell& cell = cells_[static_cast<std::size_t>(row) * grid.columns + column];
      cell.bodies.push_back(index);
      cell.top = std::min(cell.top, box.min().y());
    }
  }
}

const std::vector<std::int32_t>& SceneGeometry::bodiesAround(double x, double z) const {
  static const std::vector<std::int32_t> kNone;
  const GroundGrid& grid = terrain_.grid();
  const int column = grid.column(x);
  const int row = grid.row(z);
  return grid.contains(column, row) ? cell(column, row).bodies : kNone;
}

bool SceneGeometry::isBlocked(const Ray& ray, const RayRange& range, double pixel_m) const {
  return anyCell(
      terrain_.grid(),
      ray,
      belowHeight(ray, range, top_),
      [&](int column, int row) { return cell(column, row).top; },
      [&](int column, int row, const RayRange& in_cell) {
        double distance = 0.0;
        if (terrain_.intersect(ray, in_cell, column, row, distance)) return true;
        const std::vector<std::int32_t>& bodies = cell(column, row).bodies;
        return std::any_of(bodies.begin(), bodies.end(), [&](std::int32_t index) {
          const Body& body = bodies_[index];
          return passes(ray, in_cell, body.bounds()) && body.blocks(ray, in_cell, pixel_m);
        });
      });
}

bool SceneGeometry::traceGround(const Ray& ray, const RayRange& range, double& distance) const {
  return anyCell(
      terrain_.grid(),
      ray,
      belowHeight(ray, range, ground_top_),
      [&](int column, int row) { return terrain_.top(column, row); },
      [&](int column, int row, const RayRange& in_cell) {
        return terrain_.intersect(ray, in_cell, column, row, distance);
      });
}

}  // namespace rotrocc
