#pragma once

#include "rotrocc/stereo_camera.h"
#include "simulation/scene/body.h"
#include "simulation/surfaces/texture_tiles.h"

namespace rotrocc {

/// A lorry broadside ahead of the camera, from beyond the left border of its image on. It moves
/// with the camera, and across its view.
struct LorryPlan {
  double share = 0.0;       ///< of the image that it covers at the middle of the drive; 0: no lorry
  double across_mps = 0.0;  ///< speed to the right, relative to the camera
};

constexpr double kLorryAhead_m = 5.0;

/// Its origin is on the ground, straight ahead of the camera, in its near side. The textures must
/// outlive it.
Body makeLorry(double share, const StereoCamera& camera, const TextureTiles& tiles);

}  // namespace rotrocc
