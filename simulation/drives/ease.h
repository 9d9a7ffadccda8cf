#pragma once

namespace rotrocc {

/// From 0 at 0 to 1 at 1, with zero slope and curvature at both ends.
inline double ease(double t) {
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

}  // namespace rotrocc
