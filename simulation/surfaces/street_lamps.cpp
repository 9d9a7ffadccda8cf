#include "simulation/surfaces/street_lamps.h"

#include <algorithm>
#include <cmath>

#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kReach_m = 35.0;
constexpr double kHeight_m = 6.5;

}  // namespace

StreetLamps::StreetLamps(const SceneGeometry& scene)
    : grid_(scene.terrain().grid()),
      lamps_(static_cast<std::size_t>(grid_.columns) * static_cast<std::size_t>(grid_.rows)) {
  for (const Body& body : scene.bodies()) {
    if (!body.lamp) continue;
    const Eigen::Vector3d lamp = body.T_world_body() * *body.lamp;
    const int first_column = std::max(grid_.column(lamp.x() - kReach_m), 0);
    const int first_row = std::max(grid_.row(lamp.z() - kReach_m), 0);
    const int last_column = std::min(grid_.column(lamp.x() + kReach_m), grid_.columns - 1);
    const int last_row = std::min(grid_.row(lamp.z() + kReach_m), grid_.rows - 1);
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first_column; column <= last_column; ++column) {
        lamps_[static_cast<std::size_t>(row) * grid_.columns + column].push_back(lamp);
      }
    }
  }
}

double StreetLamps::light(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const {
  const int column = grid_.column(position.x());
  const int row = grid_.row(position.z());
  if (!grid_.contains(column, row)) return 0.0;
  double light = 0.0;
  for (const Eigen::Vector3d& lamp :
       lamps_[static_cast<std::size_t>(row) * grid_.columns + column]) {
    const Eigen::Vector3d way = position - lamp;
    const double distance = std::max(way.norm(), 0.5);
    const double facing = -normal.dot(way) / distance;
    const double down = way.y() / distance;  // cosine to the vertical: a lamp shines downwards
    if (facing <= 0.0 || down <= 0.0) continue;
    const double near = kHeight_m / distance;
    light += near * near * facing * std::sqrt(down) *
             (1.0 - smoothStep(0.5 * kReach_m, kReach_m, distance));
  }
  return light;
}

}  // namespace rotrocc
