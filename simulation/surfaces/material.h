#pragma once

#include <functional>

#include "simulation/surfaces/surface_point.h"
#include "simulation/surfaces/texture.h"

namespace rotrocc {

/// Appearance of a surface. Points are in the frame of the body: y points down, 0 is the ground.
struct Material {
  /// About 0 to 1, averaged over the pixel.
  std::function<double(const SurfacePoint&)> reflectance;

  /// Whether it is transparent at a position with a normal; a pixel is `pixel_m` wide. Holes must
  /// vanish where they are smaller than that. Empty: nowhere.
  std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&, double pixel_m)> is_hole = {};

  bool is_tangle = false;  ///< its edges need no anti-aliasing, e.g. those of leaves
};

inline Material plain(double reflectance) {
  return {[=](const SurfacePoint&) { return reflectance; }};
}

/// Coordinates on the face of a body: along it level, and up (or forward, on top of it).
inline TexturePoint faceCoordinates(const SurfacePoint& point) {
  const Eigen::Vector3d tilt = point.normal.cwiseAbs();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitZ();
  if (tilt.y() > tilt.x() && tilt.y() > tilt.z()) return project(point, right, ahead);
  return project(point, tilt.x() > tilt.z() ? ahead : right, up);
}

/// `mean` plus and minus up to half of `contrast`, by a texture that must outlive it.
inline Material textured(const Texture& texture, double mean, double contrast) {
  return {[&texture, mean, contrast](const SurfacePoint& point) {
    return mean + contrast * (texture.at(faceCoordinates(point)) - 0.5);
  }};
}

}  // namespace rotrocc
