#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace rotrocc {

/// Wind in leaves and grass.
struct Wind {
  double reach_m = 0.0;  ///< leaves and blades swing this far to each side
  double frequency_hz = 1.0;
  Eigen::Vector2d phase_rad = Eigen::Vector2d::Zero();
  double time_s = 0.0;  ///< now

  /// How far a leaf or blade is from its place on a surface [m].
  Eigen::Vector2d sway(const Eigen::Vector2d& place_m) const;
};

struct Weather {
  Wind wind;
  bool reflections = false;  ///< glass and lacquer show the sky and the sun
  double wet = 0.0;          ///< share of roads under water, from 0 to 1
  double visibility_m = std::numeric_limits<double>::infinity();  ///< where 5 % of contrast is left
};

/// Wind that moves leaves by a few cm, and reflections.
Weather windyWeather(std::uint64_t seed);

}  // namespace rotrocc
