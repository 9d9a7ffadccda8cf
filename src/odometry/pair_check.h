#pragma once

#include <string>

#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"

namespace rotrocc {

/// Why a pair is not one of this camera's, in one sentence with the value; empty if it is: both
/// images CV_8UC1 and of the camera's size.
std::string whyUnusable(const StereoPair& pair, const StereoCamera& camera);

}  // namespace rotrocc
