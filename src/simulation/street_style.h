#pragma once

#include <vector>

namespace rotrocc {

/// What the ground is covered with.
enum class Pavement { kAsphalt, kSlabs, kGrass };

/// A strip along the street; distances are from its centre line, to the right.
struct Zone {
  double left_m;
  double right_m;
  Pavement pavement;
};

/// A painted line along the street.
struct Marking {
  double right_m;  ///< of its middle
  double width_m;
  double period_m;  ///< from the beginning of a dash to the next
  double dash_m;    ///< the same as the period: a line without gaps
};

/// A painted line across the street, repeated along it.
struct Bay {
  double left_m;
  double right_m;
  double period_m;
};

/// How a street and what stands beside it look. Shares are from 0 to 1; distances from the centre
/// line to the right, [m].
struct StreetStyle {
  std::vector<Zone> zones;
  std::vector<Marking> markings;
  std::vector<Bay> bays;
  double asphalt_contrast = 1.0;    ///< 1: well worn, 0: like new
  double repairs_share = 0.25;      ///< of 12 m stretches of the street with a patch
  double lane_m = 1.75;             ///< middle of the lane one drives in; the other is at -lane_m
  double clear_half_width_m = 5.9;  ///< nothing stands nearer to a centre line

  double kerb_m = 0.0;         ///< kerb stones on both sides at this distance; 0: none
  double houses_m = 0.0;       ///< fronts of the houses; 0: no houses
  double parked_m = 0.0;       ///< middle of the cars parked on both sides; 0: none
  double parked_share = 0.0;   ///< of the places
  bool parked_across = false;  ///< at right angles to the street
  double trees_m = 0.0;        ///< a row on both sides; 0: none
  double tree_spacing_m = 14.0;
  double lamps_m = 0.0;  ///< lamp posts, and now and then a sign; 0: none
  double lamp_spacing_m = 28.0;
  double guard_rail_m = 0.0;      ///< on both sides; 0: none
  double forest_m = 0.0;          ///< where the woods begin; 0: none
  double gantry_spacing_m = 0.0;  ///< of signs over the street; 0: none
};

/// A street in a town: parked cars, pavements, houses.
StreetStyle townStyle();

/// One half of a motorway with the other beyond a guard rail, between woods.
StreetStyle motorwayStyle();

/// A single lane through a meadow.
StreetStyle rampStyle();

/// Rows of cars parked at right angles, with houses around.
StreetStyle carParkStyle();

}  // namespace rotrocc
