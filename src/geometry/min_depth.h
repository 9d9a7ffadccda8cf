#pragma once

#include <cmath>

namespace rotrocc {

/// Points closer to the image plane than this [m] are projected as if they were at this depth. It
/// keeps the residual of a wrong match finite.
constexpr double kMinDepth_m = 0.1;

/// Whether a triangulated depth [m] is finite and far enough in front of the camera.
inline bool isUsableDepth(double depth_m) {
  return std::isfinite(depth_m) && depth_m >= kMinDepth_m;
}

}  // namespace rotrocc
