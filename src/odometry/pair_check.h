#pragma once

#include <string>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Why a pair cannot be used with this camera, in one sentence with the value. Empty if it can:
/// both images are CV_8UC1 and of the camera's size.
std::string whyUnusable(const StereoPair& pair, const StereoCamera& camera);

}  // namespace rotrocc
