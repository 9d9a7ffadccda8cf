#pragma once

#include <array>
#include <string>

#include <Eigen/Geometry>

#include "rectification/stereo_calibration.h"
#include "simulation/rendering/renderer.h"

namespace rotrocc {

/// A camera with a lens, turned by up to a degree from the nominal rectified one at its place.
struct UnrectifiedCamera {
  RawCamera camera;
  PixelRays rays;  ///< as seen from the nominal camera
};

/// The left and the right camera.
using UnrectifiedRig = std::array<UnrectifiedCamera, 2>;

/// Cameras like EuRoC's with the size and about the field of view of `nominal`; `lens` is radtan or
/// equidistant. Throws std::invalid_argument on another lens or a field of view that is too wide.
UnrectifiedRig unrectifiedRig(const StereoCamera& nominal, const std::string& lens);

}  // namespace rotrocc
