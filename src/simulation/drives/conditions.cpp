#include "simulation/drives/conditions.h"

namespace rotrocc {

Scenario atNight(Scenario scenario) {
  constexpr double kArm_m = 2.0;  // of a lamp
  scenario.world.lighting = nightLighting();
  scenario.world.style.lamp_overhang_m = kArm_m;
  scenario.exposure = {0.018, 8.0};
  return scenario;
}

}  // namespace rotrocc
