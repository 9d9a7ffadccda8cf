#pragma once

#include <cstdint>

namespace rotrocc {

/// A gain that swings between two values.
struct GainSwing {
  double low = 1.0;
  double high = 1.0;
  double period_s = 1.0;
  double phase_rad = 0.0;

  double at(double time_s) const;
};

/// Gains of the cameras of a rig over time: of what they see in common, and of each for itself.
struct Gains {
  GainSwing common;
  GainSwing left;
  GainSwing right;

  double at(double time_s, bool of_right) const;
};

/// Cameras that follow the brightness of the scene together, up to a few percent.
Gains driftingGains(std::uint64_t seed);

/// Each camera exposes for itself: gains between 0.5 and 1, a quarter to half a period apart.
Gains outOfStepGains(std::uint64_t seed);

}  // namespace rotrocc
