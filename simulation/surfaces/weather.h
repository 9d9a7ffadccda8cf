#pragma once

#include <cmath>

#include <Eigen/Core>

namespace rotrocc {

/// Wind in leaves and grass.
struct Wind {
  double reach_m = 0.0;  ///< leaves and blades swing this far to each side
  double frequency_hz = 1.0;
  Eigen::Vector2d phase_rad = Eigen::Vector2d::Zero();
  double time_s = 0.0;  ///< now

  /// How far a leaf or blade is from its place on a surface [m].
  Eigen::Vector2d sway(const Eigen::Vector2d& place_m) const {
    if (reach_m <= 0.0) return Eigen::Vector2d::Zero();
    // Gusts are about 2 m long, so that neighbours move together but trees do not; the two axes are
    // out of tune.
    const double turn = 2.0 * M_PI * frequency_hz * time_s;
    const double x = 2.9 * place_m.x() + 1.3 * place_m.y() + turn + phase_rad.x();
    const double y = 1.1 * place_m.x() - 2.3 * place_m.y() + 1.37 * turn + phase_rad.y();
    return reach_m * Eigen::Vector2d(std::sin(x), 0.6 * std::sin(y));
  }
};

struct Weather {
  Wind wind;
  bool reflections = false;  ///< glass and lacquer show the sky and the sun
};

}  // namespace rotrocc
