#include "simulation/surfaces/weather.h"

#include <cmath>

#include "simulation/counter_random.h"

namespace rotrocc {

Eigen::Vector2d Wind::sway(const Eigen::Vector2d& place_m) const {
  if (reach_m <= 0.0) return Eigen::Vector2d::Zero();
  // Gusts are about 2 m long, so that neighbours move together but trees do not; the two axes are
  // out of tune.
  const double turn = 2.0 * M_PI * frequency_hz * time_s;
  const double x = 2.9 * place_m.x() + 1.3 * place_m.y() + turn + phase_rad.x();
  const double y = 1.1 * place_m.x() - 2.3 * place_m.y() + 1.37 * turn + phase_rad.y();
  return reach_m * Eigen::Vector2d(std::sin(x), 0.6 * std::sin(y));
}

Weather windyWeather(std::uint64_t seed) {
  RandomStream random(seed, 0x817D);
  Weather weather;
  weather.wind.reach_m = random.uniform(0.01, 0.03);
  weather.wind.frequency_hz = random.uniform(0.8, 1.6);
  weather.wind.phase_rad.x() = random.uniform(0.0, 2.0 * M_PI);
  weather.wind.phase_rad.y() = random.uniform(0.0, 2.0 * M_PI);
  weather.reflections = true;
  return weather;
}

}  // namespace rotrocc
