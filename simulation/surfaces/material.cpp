#include "simulation/surfaces/material.h"

namespace rotrocc {
namespace {

/// Two axes along a face.
struct FaceAxes {
  Eigen::Vector3d u;
  Eigen::Vector3d v;
};

FaceAxes faceAxes(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d tilt = normal.cwiseAbs();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  if (tilt.y() > tilt.x() && tilt.y() > tilt.z()) return {right, ahead};
  return tilt.x() > tilt.z() ? FaceAxes{ahead, up} : FaceAxes{right, up};
}

}  // namespace

TexturePoint faceCoordinates(const SurfacePoint& point) {
  const FaceAxes axes = faceAxes(point.normal);
  return project(point, axes.u, axes.v);
}

Eigen::Vector2d faceCoordinates(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
  const FaceAxes axes = faceAxes(normal);
  return {axes.u.dot(position), axes.v.dot(position)};
}

}  // namespace rotrocc
