#include "simulation/scene/placement.h"

#include <cmath>

namespace rotrocc {
namespace {

Eigen::Isometry3d poseWithAxes(const Eigen::Vector3d& down,
                               const Eigen::Vector3d& ahead,
                               const Eigen::Vector3d& position) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d right = down.cross(ahead).normalized();
  pose.linear().col(0) = right;
  pose.linear().col(1) = down;
  pose.linear().col(2) = right.cross(down);
  pose.translation() = position;
  return pose;
}

Eigen::Vector3d onGround(const Terrain& terrain, const Eigen::Vector2d& at) {
  return {at.x(), terrain.height(at.x(), at.y()), at.y()};
}

/// Half the length of a rectangle's projection on an axis.
double halfExtent(const Footprint& footprint, const Eigen::Vector2d& axis) {
  return footprint.half_length * std::abs(axis.dot(footprint.ahead)) +
         footprint.half_width * std::abs(axis.dot(footprint.right));
}

}  // namespace

Eigen::Isometry3d standingUpright(const Terrain& terrain,
                                  const Eigen::Vector2d& at,
                                  const Eigen::Vector3d& ahead) {
  return poseWithAxes(Eigen::Vector3d::UnitY(), ahead, onGround(terrain, at));
}

Eigen::Isometry3d lyingOnGround(const Terrain& terrain,
                                const Eigen::Vector2d& at,
                                const Eigen::Vector3d& ahead) {
  // Mean slope: the slope at a point is discontinuous between cells.
  constexpr double kReach = 1.5;
  const double dx =
      terrain.height(at.x() + kReach, at.y()) - terrain.height(at.x() - kReach, at.y());
  const double dz =
      terrain.height(at.x(), at.y() + kReach) - terrain.height(at.x(), at.y() - kReach);
  const Eigen::Vector3d down = Eigen::Vector3d(-dx, 2.0 * kReach, -dz).normalized();
  return poseWithAxes(down, ahead, onGround(terrain, at));
}

Footprint Footprint::of(const Body& body) {
  const Eigen::Isometry3d& pose = body.T_world_body();
  const Eigen::Vector3d centre = pose * body.ownBounds().center();
  const Eigen::Vector3d half = 0.5 * body.ownBounds().sizes();
  Footprint footprint;
  footprint.centre = {centre.x(), centre.z()};
  footprint.ahead = Eigen::Vector2d(pose.linear()(0, 2), pose.linear()(2, 2)).normalized();
  footprint.right = Eigen::Vector2d(pose.linear()(0, 0), pose.linear()(2, 0)).normalized();
  footprint.half_length = half.z();
  footprint.half_width = half.x();
  return footprint;
}

bool Footprint::overlaps(const Footprint& other, double margin_m) const {
  for (const Eigen::Vector2d& axis : {ahead, right, other.ahead, other.right}) {
    const double gap = std::abs(axis.dot(other.centre - centre)) - halfExtent(*this, axis) -
                       halfExtent(other, axis);
    if (gap > -margin_m) return false;  // separating axis
  }
  return true;
}

std::vector<Eigen::Vector2d> Footprint::border(double spacing_m) const {
  std::vector<Eigen::Vector2d> points;
  const auto addSides = [&](const Eigen::Vector2d& along, double half, const Eigen::Vector2d& out) {
    const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * half / spacing_m)));
    for (int i = 0; i <= steps; ++i) {
      const double offset = half * (2.0 * i / steps - 1.0);
      points.push_back(centre + offset * along + out);
      points.push_back(centre + offset * along - out);
    }
  };
  addSides(ahead, half_length, half_width * right);
  addSides(right, half_width, half_length * ahead);
  return points;
}

}  // namespace rotrocc
