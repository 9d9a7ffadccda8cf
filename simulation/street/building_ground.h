#pragma once

#include <vector>

#include "simulation/scene/body.h"
#include "simulation/scene/placement.h"
#include "simulation/scene/terrain.h"
#include "simulation/scene/world.h"
#include "simulation/street/path.h"
#include "simulation/street/street_map.h"

namespace rotrocc {

/// Orientation of a body beside a street: the direction of its z axis.
enum class Facing { kAhead, kBack, kOutwards };

/// Placement rules.
struct PlacementRules {
  double clearance_m;        // from every centre line
  bool may_overlap = false;  // with bodies placed earlier
  bool upright = true;       // otherwise it follows the slope
  bool contact_shadow = false;
};

/// The ground beside the streets, and the bodies placed there.
class BuildingGround {
 public:
  /// Streets and terrain must outlive this object.
  BuildingGround(const WorldPlan& plan, const StreetMap& streets, const Terrain& terrain);

  /// Places a body `right_m` beside a street if the rules allow it. Returns whether they do.
  bool place(Body body,
             const Path& street,
             double station_m,
             double right_m,
             Facing facing,
             const PlacementRules& rules);

  /// Places a body over a street, across it.
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
