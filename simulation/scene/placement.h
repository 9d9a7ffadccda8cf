#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "simulation/scene/body.h"
#include "simulation/scene/terrain.h"

namespace rotrocc {

/// The pose of a body that stands upright on the ground at (x, z) with its z axis along `ahead`
/// (level, of unit length).
Eigen::Isometry3d standingUpright(const Terrain& terrain,
                                  const Eigen::Vector2d& at,
                                  const Eigen::Vector3d& ahead);

/// The same for a body that follows the slope of the ground: cars, kerb stones.
Eigen::Isometry3d lyingOnGround(const Terrain& terrain,
                                const Eigen::Vector2d& at,
                                const Eigen::Vector3d& ahead);

/// Footprint of a body on the ground (x, z).
struct Footprint {
  Eigen::Vector2d centre;
  Eigen::Vector2d ahead;  ///< of unit length
  Eigen::Vector2d right;
  double half_length;  ///< along `ahead`
  double half_width;

  /// Footprint of a placed body.
  static Footprint of(const Body& body);

  /// Whether two rectangles overlap by more than `margin_m`.
  bool overlaps(const Footprint& other, double margin_m) const;

  /// Points along its border, at most `spacing_m` from each other.
  std::vector<Eigen::Vector2d> border(double spacing_m) const;
};

}  // namespace rotrocc
