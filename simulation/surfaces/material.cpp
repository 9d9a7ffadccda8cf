#include "simulation/surfaces/material.h"

namespace rotrocc {

TexturePoint faceCoordinates(const SurfacePoint& point) {
  const Eigen::Vector3d tilt = point.normal.cwiseAbs();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  if (tilt.y() > tilt.x() && tilt.y() > tilt.z()) return project(point, right, ahead);
  return project(point, tilt.x() > tilt.z() ? ahead : right, up);
}

}  // namespace rotrocc
