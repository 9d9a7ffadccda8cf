#pragma once

#include <vector>

namespace rotrocc {

enum class Pavement { kAsphalt, kSlabs, kGrass };

/// A strip along the street; distances are from its center line, to the right.
struct Zone {
  double left_m;
  double right_m;
  Pavement pavement;
};

struct Marking {
  double right_m;  ///< center of the line
  double width_m;
  double period_m;  ///< from the start of a dash to the next
  double dash_m;    ///< equal to the period: a solid line
};

/// A painted line across the street, repeated along it.
struct Bay {
  double left_m;
  double right_m;
  double period_m;
};

/// Appearance of a street and its surroundings; distances are from its center line to the right.
struct StreetStyle {
  std::vector<Zone> zones;
  std::vector<Marking> markings;
  std::vector<Bay> bays;
  double asphalt_contrast = 1.0;    ///< 1: well worn, 0: like new
  double repairs_share = 0.25;      ///< share of 12 m sections with a patch
  double lane_m = 1.75;             ///< center of the own lane; the other is at -lane_m
  double clear_half_width_m = 5.9;  ///< minimum distance of bodies from a center line

  double kerb_m = 0.0;         ///< kerb stones on both sides at this distance; 0: none
  double houses_m = 0.0;       ///< fronts of the houses; 0: no houses
  double parked_m = 0.0;       ///< center of the cars parked on both sides; 0: none
  double parked_share = 0.0;   ///< occupied share of the places
  bool parked_across = false;  ///< at right angles to the street
  double trees_m = 0.0;        ///< a row on both sides; 0: none
  double lamps_m = 0.0;        ///< lamp posts and occasional signs; 0: none
  double lamp_spacing_m = 28.0;
  double lamp_overhang_m = 1.8;   ///< lamps that reach farther towards the street are left out
  double guard_rail_m = 0.0;      ///< on both sides; 0: none
  double forest_m = 0.0;          ///< edge of the woods; 0: none
  double gantry_spacing_m = 0.0;  ///< of signs over the street; 0: none
};

}  // namespace rotrocc
