#pragma once

#include <string>

#include <Eigen/Geometry>

#include "rectification/stereo_calibration.h"
#include "simulation/rendering/picture.h"

namespace rotrocc {

/// A camera with a lens, turned by up to a degree from the nominal rectified one at its place.
struct UnrectifiedCamera {
  RawCamera camera;
  PixelRays rays;  ///< as seen from the nominal camera
};

/// A rig whose images are not rectified. Its calibration is exact.
struct UnrectifiedRig {
  UnrectifiedCamera left;
  UnrectifiedCamera right;
};

/// Cameras like those of EuRoC, with the size and about the field of view of `nominal`. `lens` is
/// radtan or equidistant. Throws std::invalid_argument on another lens, and if the field of view is
/// too wide for the renderer.
UnrectifiedRig unrectifiedRig(const StereoCamera& nominal, const std::string& lens);

}  // namespace rotrocc
