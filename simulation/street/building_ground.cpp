#include "simulation/street/building_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rotrocc {
namespace {

constexpr double kDriveClearance_m = 1.6;  // from where cars drive: half a car and something

Eigen::Vector3d level(Eigen::Vector3d direction) {
  direction.y() = 0.0;
  return direction.normalized();
}

}  // namespace

BuildingGround::BuildingGround(const WorldPlan& plan,
                               const StreetMap& streets,
                               const Terrain& terrain)
    : streets_(streets), drives_(plan.wholeDrives(), kDriveClearance_m + 1.0), terrain_(terrain) {}

bool BuildingGround::place(Body body,
                           const Path& street,
                           double station_m,
                           double right_m,
                           Facing facing,
                           const PlacementRules& rules) {
  const Eigen::Vector3d right = street.right(station_m);
  const Eigen::Vector3d position = street.position(station_m) + right_m * right;
  const Eigen::Vector2d at(position.x(), position.z());
  Eigen::Vector3d ahead = std::copysign(1.0, right_m) * right;
  if (facing != Facing::kOutwards) {
    ahead = level(street.direction(station_m) * (facing == Facing::kAhead ? 1.0 : -1.0));
  }
  body.place(rules.upright ? standingUpright(terrain_, at, ahead)
                           : lyingOnGround(terrain_, at, ahead));
  const Footprint footprint = Footprint::of(body);
  if (!isFree(footprint, rules)) return false;
  if (!rules.may_overlap) taken_.push_back(footprint);
  body.contact_shadow = rules.contact_shadow;
  bodies_.push_back(std::move(body));
  return true;
}

void BuildingGround::placeAcross(Body body, const Path& street, double station_m) {
  const Eigen::Vector3d position = street.position(station_m);
  body.place(
      standingUpright(terrain_, {position.x(), position.z()}, level(street.direction(station_m))));
  bodies_.push_back(std::move(body));
}

bool BuildingGround::isFree(const Footprint& footprint, const PlacementRules& rules) const {
  for (const Eigen::Vector2d& point : footprint.border(0.8)) {
    if (streets_.distance(point.x(), point.y()) < rules.clearance_m) return false;
    if (drives_.distance(point.x(), point.y()) < kDriveClearance_m) return false;
  }
  if (rules.may_overlap) return true;
  return std::none_of(taken_.begin(), taken_.end(), [&](const Footprint& other) {
    return footprint.overlaps(other, 0.3);
  });
}

}  // namespace rotrocc
