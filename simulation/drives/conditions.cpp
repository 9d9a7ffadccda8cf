#include "simulation/drives/conditions.h"

namespace rotrocc {

Scenario atNight(Scenario scenario) {
  constexpr double kArm_m = 2.0;  // of a lamp
  scenario.world.lighting = nightLighting();
  scenario.world.style.lamp_overhang_m = kArm_m;
  scenario.exposure = {0.018, 8.0};
  return scenario;
}

Scenario inRain(Scenario scenario) {
  scenario.world.lighting = rainLighting();
  scenario.world.weather.wet = 0.8;
  scenario.world.weather.visibility_m = 500.0;
  scenario.exposure = {0.006, 2.0};
  scenario.rain.drops = 40.0;
  scenario.rain.streaks = 2500.0;
  return scenario;
}

}  // namespace rotrocc
