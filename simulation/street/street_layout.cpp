#include "simulation/street/street_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/counter_random.h"
#include "simulation/objects/objects.h"

namespace rotrocc {
namespace {

constexpr double kKerb_m = 1.5;            // length of a stone
constexpr double kRail_m = 4.0;            // from post to post
constexpr double kTree_m = 14.0;           // from tree to tree
constexpr double kDriveClearance_m = 1.6;  // from where cars drive: half a car and something

Eigen::Vector3d level(Eigen::Vector3d direction) {
  direction.y() = 0.0;
  return direction.normalized();
}

/// Orientation of a body beside a street: the direction of its z axis.
enum class Facing { kAhead, kBack, kOutwards };

struct PlacementRules {
  double clearance_m;        // from every center line
  bool may_overlap = false;  // with bodies placed earlier
  bool upright = true;       // otherwise it follows the slope
  bool contact_shadow = false;
};

/// Footprint of a body on the ground (x, z).
struct Footprint {
  /// Of a placed body.
  static Footprint of(const Body& body) {
    const Eigen::Isometry3d& pose = body.T_world_body();
    const Eigen::Vector3d center = pose * body.ownBounds().center();
    const Eigen::Vector3d half = 0.5 * body.ownBounds().sizes();
    Footprint footprint;
    footprint.center = {center.x(), center.z()};
    footprint.ahead = Eigen::Vector2d(pose.linear()(0, 2), pose.linear()(2, 2)).normalized();
    footprint.right = Eigen::Vector2d(pose.linear()(0, 0), pose.linear()(2, 0)).normalized();
    footprint.half_length = half.z();
    footprint.half_width = half.x();
    return footprint;
  }

  /// Half the length of its projection on an axis.
  double halfExtent(const Eigen::Vector2d& axis) const {
    return half_length * std::abs(axis.dot(ahead)) + half_width * std::abs(axis.dot(right));
  }

  /// Whether two rectangles overlap by more than `margin_m`.
  bool overlaps(const Footprint& other, double margin_m) const {
    for (const Eigen::Vector2d& axis : {ahead, right, other.ahead, other.right}) {
      const double gap =
          std::abs(axis.dot(other.center - center)) - halfExtent(axis) - other.halfExtent(axis);
      if (gap > -margin_m) return false;  // separating axis
    }
    return true;
  }

  /// Points along its border, at most `spacing_m` from each other.
  std::vector<Eigen::Vector2d> border(double spacing_m) const {
    std::vector<Eigen::Vector2d> points;
    const auto addSides =
        [&](const Eigen::Vector2d& along, double half, const Eigen::Vector2d& out) {
          const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * half / spacing_m)));
          for (int i = 0; i <= steps; ++i) {
            const double offset = half * (2.0 * i / steps - 1.0);
            points.push_back(center + offset * along + out);
            points.push_back(center + offset * along - out);
          }
        };
    addSides(ahead, half_length, half_width * right);
    addSides(right, half_width, half_length * ahead);
    return points;
  }

  Eigen::Vector2d center;
  Eigen::Vector2d ahead;  // of unit length
  Eigen::Vector2d right;
  double half_length;  // along `ahead`
  double half_width;
};

/// The ground beside the streets, and the bodies placed there.
class BuildingGround {
 public:
  BuildingGround(const WorldPlan& plan, const StreetMap& streets, const Terrain& terrain)
      : streets_(streets),
        drive_({plan.drive.beside(0.0, plan.beyond_m)}, kDriveClearance_m + 1.0),
        terrain_(terrain) {}

  /// Places a body `right_m` beside a street if the rules allow it. Returns whether they do.
  bool place(Body body,
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
    body.place(rules.upright ? terrain_.standing(at, ahead) : terrain_.lying(at, ahead));
    const Footprint footprint = Footprint::of(body);
    if (!isFree(footprint, rules)) return false;
    if (!rules.may_overlap) taken_.push_back(footprint);
    body.contact_shadow = rules.contact_shadow;
    bodies_.push_back(std::move(body));
    return true;
  }

  /// Places a body over a street, across it.
  void placeAcross(Body body, const Path& street, double station_m) {
    const Eigen::Vector3d position = street.position(station_m);
    body.place(terrain_.standing({position.x(), position.z()}, level(street.direction(station_m))));
    bodies_.push_back(std::move(body));
  }

  std::vector<Body> takeBodies() { return std::move(bodies_); }

 private:
  bool isFree(const Footprint& footprint, const PlacementRules& rules) const {
    for (const Eigen::Vector2d& point : footprint.border(0.8)) {
      if (streets_.distance(point.x(), point.y()) < rules.clearance_m) return false;
      if (drive_.distance(point.x(), point.y()) < kDriveClearance_m) return false;
    }
    if (rules.may_overlap) return true;
    return std::none_of(taken_.begin(), taken_.end(), [&](const Footprint& other) {
      return footprint.overlaps(other, 0.3);
    });
  }

  const StreetMap& streets_;
  StreetMap drive_;
  const Terrain& terrain_;
  std::vector<Footprint> taken_;
  std::vector<Body> bodies_;
};

class Layout {
 public:
  Layout(const WorldPlan& plan,
         const StreetMap& streets,
         const Terrain& terrain,
         const TextureTiles& tiles)
      : plan_(plan), style_(plan.style), ground_(plan, streets, terrain), tiles_(tiles) {}

  std::vector<Body> build() {
    for (std::size_t i = 0; i < plan_.streets.size(); ++i) {
      for (const double side : {-1.0, 1.0}) {
        const auto stream = static_cast<std::uint64_t>(2 * i) + (side > 0.0 ? 1 : 0);
        buildSide(plan_.streets[i], side, RandomStream(plan_.seed, stream));
      }
      addGantries(plan_.streets[i], RandomStream(plan_.seed + 1, i));
    }
    return ground_.takeBodies();
  }

 private:
  void buildSide(const Path& street, double side, RandomStream random) {
    if (style_.houses_m > 0.0) addHouses(street, side, random);
    if (style_.parked_m > 0.0) addParkedCars(street, side, random);
    if (style_.kerb_m > 0.0) {
      addLine(street, side * style_.kerb_m, kKerb_m, style_.kerb_m - 0.3, [&] {
        return makeKerb(kKerb_m, tiles_, random);
      });
    }
    if (style_.guard_rail_m > 0.0) {
      addLine(street, side * style_.guard_rail_m, kRail_m, style_.clear_half_width_m, [&] {
        return makeGuardRail(kRail_m, tiles_);
      });
    }
    if (style_.lamps_m > 0.0) addPosts(street, side, random);
    if (style_.trees_m > 0.0) addTrees(street, side, random);
    if (style_.forest_m > 0.0) addForest(street, side, random);
  }

  /// Length of a line `right_m` beside the street over the length of the street.
  static double stretch(const Path& street, double station_m, double right_m) {
    const Eigen::Vector3d before =
        street.position(station_m - 0.5) + right_m * street.right(station_m - 0.5);
    const Eigen::Vector3d after =
        street.position(station_m + 0.5) + right_m * street.right(station_m + 0.5);
    return std::max(0.2, (after - before).norm());
  }

  void addHouses(const Path& street, double side, RandomStream& random) {
    const PlacementRules rules = {style_.houses_m - 0.3, false, true, true};
    for (double station = 0.0; station < street.length_m();) {
      const HouseSize size{random.uniform(8.0, 15.0), random.uniform(8.0, 11.0)};
      const double right = side * (style_.houses_m + 0.5 * size.depth + random.uniform(0.0, 0.4));
      const double front_stretch = stretch(street, station, side * style_.houses_m);
      const double middle = station + 0.5 * size.width / front_stretch;
      if (!ground_.place(
              makeHouse(size, tiles_, random), street, middle, right, Facing::kOutwards, rules)) {
        station += 2.0;
        continue;
      }
      station += size.width / front_stretch;
      if (random.chance(0.22)) station += addGap(street, side, station, random);
    }
  }

  /// A garden between two houses, behind a hedge; returns its length along the street.
  double addGap(const Path& street, double side, double station, RandomStream& random) {
    const double length = random.uniform(4.0, 8.0);
    const double front = side * (style_.houses_m + 0.6);
    const PlacementRules rules = {style_.houses_m - 0.3, false, true, true};
    ground_.place(makeHedge(length - 0.8, tiles_, random),
                  street,
                  station + 0.5 * length,
                  front,
                  Facing::kOutwards,
                  rules);
    ground_.place(makeTree(tiles_, random),
                  street,
                  station + 0.5 * length,
                  side * (style_.houses_m + 4.0),
                  Facing::kOutwards,
                  {style_.houses_m, true});
    return length;
  }

  void addParkedCars(const Path& street, double side, RandomStream& random) {
    const PlacementRules rules = {
        style_.clear_half_width_m - (style_.parked_across ? 0.2 : 2.3), false, false, true};
    const double spacing = style_.parked_across ? 2.6 : 6.0;
    for (double station = 0.5 * spacing; station < street.length_m(); station += spacing) {
      Body car = makeCar(random);
      const double shift = random.uniform(-0.3, 0.3) * (style_.parked_across ? 0.3 : 1.0);
      const bool other_way = random.chance(style_.parked_across ? 0.3 : 0.05);
      if (!random.chance(style_.parked_share)) continue;
      const double right = side * (style_.parked_m + 0.3 * shift);
      Facing facing = (side > 0.0) != other_way ? Facing::kAhead : Facing::kBack;
      if (style_.parked_across) facing = Facing::kOutwards;
      car.own_shade = true;
      ground_.place(std::move(car), street, station + shift, right, facing, rules);
    }
  }

  /// A line of equal pieces, `right_m` beside the street; `make` makes the next one.
  template <class Make>
  void addLine(const Path& street, double right_m, double length_m, double clearance_m, Make make) {
    const PlacementRules rules = {clearance_m, true, false, false};
    for (double station = 0.0; station < street.length_m();) {
      const double step = length_m / stretch(street, station, right_m);
      ground_.place(make(), street, station + 0.5 * step, right_m, Facing::kOutwards, rules);
      station += step;
    }
  }

  void addPosts(const Path& street, double side, RandomStream& random) {
    const PlacementRules rules = {style_.lamps_m - style_.lamp_overhang_m, true};
    const double start = side > 0.0 ? 6.0 : 6.0 + 0.5 * style_.lamp_spacing_m;
    for (double station = start; station < street.length_m(); station += style_.lamp_spacing_m) {
      ground_.place(makeLamp(), street, station, side * style_.lamps_m, Facing::kOutwards, rules);
      const Facing facing = side > 0.0 ? Facing::kAhead : Facing::kBack;
      const double sign = station + random.uniform(3.0, 12.0);
      Body body = makeSign(tiles_, random);
      if (random.chance(0.7))
        ground_.place(std::move(body), street, sign, side * style_.lamps_m, facing, rules);
      const double bin = station + random.uniform(-8.0, 8.0);
      if (style_.houses_m > 0.0 && random.chance(0.4)) {
        ground_.place(makeBin(random), street, bin, side * (style_.lamps_m + 0.5), facing, rules);
      }
    }
  }

  void addTrees(const Path& street, double side, RandomStream& random) {
    const PlacementRules rules = {style_.clear_half_width_m - 2.3, true};
    for (double station = 3.0; station < street.length_m(); station += kTree_m) {
      Body tree = makeTree(tiles_, random);
      const double at = station + random.uniform(-2.0, 2.0);
      if (!random.chance(0.7)) continue;
      ground_.place(std::move(tree), street, at, side * style_.trees_m, Facing::kOutwards, rules);
    }
  }

  void addForest(const Path& street, double side, RandomStream& random) {
    const PlacementRules rules = {12.0, true};
    for (double station = 0.0; station < street.length_m(); station += 3.0) {
      const double right = style_.forest_m + 26.0 * std::pow(random.uniform(0.0, 1.0), 1.5);
      const double at = station + random.uniform(-1.5, 1.5);
      ground_.place(
          makeForestTree(tiles_, random), street, at, side * right, Facing::kOutwards, rules);
    }
  }

  void addGantries(const Path& street, RandomStream random) {
    if (style_.gantry_spacing_m <= 0.0) return;
    for (double station = 110.0; station < street.length_m(); station += style_.gantry_spacing_m) {
      ground_.placeAcross(makeGantry(8.2, tiles_, random), street, station);
    }
  }

  const WorldPlan& plan_;
  const StreetStyle& style_;
  BuildingGround ground_;
  const TextureTiles& tiles_;
};

}  // namespace

std::vector<Body> layOutStreets(const WorldPlan& plan,
                                const StreetMap& streets,
                                const Terrain& terrain,
                                const TextureTiles& tiles) {
  return Layout(plan, streets, terrain, tiles).build();
}

}  // namespace rotrocc
