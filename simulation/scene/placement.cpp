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

}  // namespace rotrocc
