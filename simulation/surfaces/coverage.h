#pragma once

#include <algorithm>
#include <cmath>

namespace rotrocc {

/// Integer floor; faster than std::floor, for values that fit an int.
template <typename Real>
int floorToInt(Real x) {
  const int whole = static_cast<int>(x);
  return whole - (x < static_cast<Real>(whole) ? 1 : 0);
}

/// Patterns with sharp edges, averaged over a pixel of width `width` to avoid aliasing. All lengths
/// in the same unit, widths positive.

/// Share of the pixel at `x` that lies above `edge`.
inline double coverageAbove(double edge, double x, double width) {
  return std::clamp((x - edge) / width + 0.5, 0.0, 1.0);
}

/// Share of the pixel at `x` that lies in [low, high].
inline double coverageBetween(double low, double high, double x, double width) {
  const double first = std::max(low, x - 0.5 * width);
  const double last = std::min(high, x + 0.5 * width);
  return std::max(0.0, last - first) / width;
}

/// Share of the pixel at `x` that lies in [0, length] or its repetitions every `period`.
inline double coveragePeriodic(double period, double length, double x, double width) {
  const auto covered_up_to = [&](double end) {
    const int whole = floorToInt(end / period);
    return whole * length + std::min(end - whole * period, length);
  };
  return (covered_up_to(x + 0.5 * width) - covered_up_to(x - 0.5 * width)) / width;
}

/// Smooth step from 0 at `low` to 1 at `high`.
inline double smoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

inline double mix(double a, double b, double share_of_b) {
  return a + (b - a) * share_of_b;
}

}  // namespace rotrocc
