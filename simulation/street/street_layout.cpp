#include "simulation/street/street_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/counter_random.h"
#include "simulation/objects/car.h"
#include "simulation/objects/field_things.h"
#include "simulation/objects/house.h"
#include "simulation/objects/street_furniture.h"
#include "simulation/objects/vegetation.h"
#include "simulation/street/building_ground.h"

namespace rotrocc {
namespace {

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
    if (style_.kerb_m > 0.0) addKerbs(street, side, random);
    if (style_.guard_rail_m > 0.0) addGuardRails(street, side);
    if (style_.lamps_m > 0.0) addPosts(street, side, random);
    if (style_.trees_m > 0.0) addTrees(street, side, random);
    if (style_.forest_m > 0.0) addForest(street, side, random);
    if (style_.stones_per_m > 0.0) addStones(street, side, random);
    if (style_.bushes_per_m > 0.0) addBushes(street, side, random);
    if (style_.fence_m > 0.0 && side < 0.0) addFence(street, random);
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

  void addKerbs(const Path& street, double side, RandomStream& random) {
    constexpr double kLength = 1.5;
    const PlacementRules rules = {style_.kerb_m - 0.3, true, false, false};
    for (double station = 0.0; station < street.length_m();) {
      const double step = kLength / stretch(street, station, side * style_.kerb_m);
      ground_.place(makeKerb(kLength, tiles_, random),
                    street,
                    station + 0.5 * step,
                    side * style_.kerb_m,
                    Facing::kOutwards,
                    rules);
      station += step;
    }
  }

  void addGuardRails(const Path& street, double side) {
    constexpr double kLength = 4.0;
    const PlacementRules rules = {style_.clear_half_width_m, true, false, false};
    for (double station = 0.0; station < street.length_m();) {
      const double step = kLength / stretch(street, station, side * style_.guard_rail_m);
      ground_.place(makeGuardRail(kLength, tiles_),
                    street,
                    station + 0.5 * step,
                    side * style_.guard_rail_m,
                    Facing::kOutwards,
                    rules);
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
    for (double station = 3.0; station < street.length_m(); station += style_.tree_spacing_m) {
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

  void addStones(const Path& street, double side, RandomStream& random) {
    constexpr double kNearest_m = 1.7;
    constexpr double kSpread_m = 12.0;
    const PlacementRules rules = {style_.clear_half_width_m, true, true, true};
    for (double station = 0.0; station < street.length_m(); station += 1.0 / style_.stones_per_m) {
      const double away = kNearest_m + kSpread_m * std::pow(random.uniform(0.0, 1.0), 2.0);
      const double at = station + random.uniform(-0.5, 0.5);
      ground_.place(makeStone(tiles_, random), street, at, side * away, Facing::kOutwards, rules);
    }
  }

  void addBushes(const Path& street, double side, RandomStream& random) {
    constexpr double kNearest_m = 2.2;
    constexpr double kSpread_m = 25.0;
    const PlacementRules rules = {style_.clear_half_width_m, true, true, true};
    for (double station = 0.0; station < street.length_m(); station += 1.0 / style_.bushes_per_m) {
      const double away = kNearest_m + kSpread_m * random.uniform(0.0, 1.0);
      const double at = station + random.uniform(-4.0, 4.0);
      ground_.place(makeBush(tiles_, random), street, at, side * away, Facing::kOutwards, rules);
    }
  }

  void addFence(const Path& street, RandomStream& random) {
    constexpr double kLength = 2.5;
    const PlacementRules rules = {style_.clear_half_width_m, true, false, false};
    for (double station = 0.0; station < street.length_m();) {
      const double step = kLength / stretch(street, station, -style_.fence_m);
      ground_.place(makeFence(kLength, tiles_, random),
                    street,
                    station + 0.5 * step,
                    -style_.fence_m,
                    Facing::kOutwards,
                    rules);
      station += step;
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
