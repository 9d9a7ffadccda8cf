#pragma once

#include <vector>

#include "simulation/body.h"
#include "simulation/path.h"
#include "simulation/placement.h"
#include "simulation/street_map.h"
#include "simulation/terrain.h"
#include "simulation/world.h"

namespace rotrocc {

/// Which way a body beside a street looks: the direction of its z axis.
enum class Facing { kAhead, kBack, kOutwards };

/// What may stand where.
struct PlacementRules {
  double clearance_m;        // from every centre line
  bool may_overlap = false;  // with what stands already
  bool upright = true;       // else it lies on the slope
  bool contact_shadow = false;
};

/// The ground beside the streets, and what stands there already.
class BuildingGround {
 public:
  /// Streets and terrain must outlive it.
  BuildingGround(const WorldPlan& plan, const StreetMap& streets, const Terrain& terrain);

  /// Stands a body `right_m` beside a street and returns true, if the rules allow.
  bool place(Body body,
             const Path& street,
             double station_m,
             double right_m,
             Facing facing,
             const PlacementRules& rules);

  /// Stands a body over a street, across it.
  void placeAcross(Body body, const Path& street, double station_m);

  /// Everything that was placed.
  std::vector<Body> takeBodies() { return std::move(bodies_); }

 private:
  bool isFree(const Footprint& footprint, const PlacementRules& rules) const;

  const StreetMap& streets_;
  StreetMap drives_;
  const Terrain& terrain_;
  std::vector<Footprint> taken_;
  std::vector<Body> bodies_;
};

}  // namespace rotrocc
