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

}  // namespace rotrocc
