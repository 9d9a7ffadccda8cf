#pragma once

#include <Eigen/Geometry>

#include "simulation/drives/traffic.h"
#include "simulation/rendering/picture.h"
#include "simulation/scene/world.h"

namespace rotrocc {

/// The picture of a camera at a pose in the world. Uses all threads of OpenCV; the result is
/// independent of their number.
Picture render(const World& world,
               const MovingCars& cars,
               const PixelRays& rays,
               const Eigen::Isometry3d& T_world_camera);

}  // namespace rotrocc
