#include "simulation/street/street_style.h"

namespace rotrocc {
namespace {

constexpr double kFar_m = 1000.0;

Marking line(double right_m, double width_m) {
  return {right_m, width_m, 1.0, 1.0};
}

}  // namespace

StreetStyle townStyle() {
  StreetStyle style;
  style.zones = {{-5.7, 5.7, Pavement::kAsphalt},
                 {-10.5, -5.7, Pavement::kSlabs},
                 {5.7, 10.5, Pavement::kSlabs}};
  style.markings = {{0.0, 0.13, 6.0, 3.0}, {-3.5, 0.12, 2.0, 1.0}, {3.5, 0.12, 2.0, 1.0}};
  style.kerb_m = 5.8;
  style.houses_m = 9.0;
  style.parked_m = 4.65;
  style.parked_share = 0.6;
  style.trees_m = 6.7;
  style.lamps_m = 6.3;
  return style;
}

StreetStyle motorwayStyle() {
  StreetStyle style;
  style.zones = {{-4.9, 6.8, Pavement::kAsphalt}, {-19.5, -7.8, Pavement::kAsphalt}};
  style.markings = {{0.0, 0.15, 18.0, 6.0},
                    line(-3.75, 0.2),
                    line(3.75, 0.25),
                    {-12.7, 0.15, 18.0, 6.0},
                    line(-8.9, 0.2),
                    line(-16.5, 0.25)};
  style.asphalt_contrast = 0.35;
  style.repairs_share = 0.0;
  style.lane_m = 1.9;
  style.clear_half_width_m = 5.5;
  style.guard_rail_m = 7.4;
  style.forest_m = 24.0;
  style.gantry_spacing_m = 240.0;
  return style;
}

StreetStyle rampStyle() {
  StreetStyle style;
  style.zones = {{-3.4, 3.4, Pavement::kAsphalt}};
  style.markings = {line(-2.9, 0.15), line(2.9, 0.15)};
  style.asphalt_contrast = 0.4;
  style.repairs_share = 0.0;
  style.lane_m = 0.0;
  style.clear_half_width_m = 3.6;
  style.lamps_m = 4.6;
  style.lamp_spacing_m = 45.0;
  style.forest_m = 30.0;
  return style;
}

StreetStyle carParkStyle() {
  StreetStyle style;
  style.zones = {{-kFar_m, kFar_m, Pavement::kAsphalt}};
  style.bays = {{-8.3, -3.4, 2.6}, {3.4, 8.3, 2.6}};
  style.lane_m = 0.9;
  style.clear_half_width_m = 3.3;
  style.kerb_m = 8.6;
  style.houses_m = 14.0;
  style.parked_m = 5.8;
  style.parked_share = 0.65;
  style.parked_across = true;
  style.trees_m = 10.0;
  style.lamps_m = 9.2;
  style.lamp_spacing_m = 18.0;
  return style;
}

}  // namespace rotrocc
