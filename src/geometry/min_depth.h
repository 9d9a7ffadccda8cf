#pragma once

#include <cmath>

namespace rotrocc {

/// Points nearer to the image plane than this are projected as if they were there [m]: keeps the
/// residual of a wrong match finite.
constexpr double kMinDepth_m = 0.1;

/// Whether a triangulated depth [m] is that of a point in front of the camera, not at infinity.
inline bool isUsableDepth(double depth_m) {
  return std::isfinite(depth_m) && depth_m >= kMinDepth_m;
}

}  // namespace rotrocc
