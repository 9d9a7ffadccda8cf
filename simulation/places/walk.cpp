#include "simulation/places/walk.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "simulation/counter_random.h"
#include "simulation/drives/free_drive.h"
#include "simulation/objects/house.h"
#include "simulation/objects/street_furniture.h"
#include "simulation/objects/vegetation.h"
#include "simulation/surfaces/coverage.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;

// The lane runs along z, with a stair up; the side lane branches off to the right.
constexpr int kSteps = 16;
constexpr double kRise_m = 0.17;
constexpr double kTread_m = 0.3125;
constexpr double kFoot_m = 12.0;  // where the stair begins
constexpr double kTop_m = kFoot_m + kSteps * kTread_m;
constexpr double kGain_m = kSteps * kRise_m;
constexpr double kSideLane_m = 24.0;
constexpr double kBegin_m = -48.0;  // of the lane
constexpr double kEnd_m = 66.0;
constexpr double kSideEnd_m = 52.0;
constexpr double kHalfWidth_m = 2.6;  // of the stair
constexpr double kNeck_m = 1.55;      // above the ground

/// The ground under the stair is a slope below its steps.
double groundHeight(double /*x*/, double z) {
  constexpr double kBelow_m = 0.06;
  if (z <= kFoot_m) return 0.0;
  if (z >= kTop_m) return -kGain_m;
  return kBelow_m - kGain_m * (z - kFoot_m) / (kTop_m - kFoot_m);
}

StreetStyle laneStyle() {
  StreetStyle style;
  style.zones = {{-3.4, 3.4, Pavement::kSlabs}};
  style.lane_m = 0.0;
  style.clear_half_width_m = 2.2;
  style.houses_m = 3.2;
  style.lamps_m = 2.75;  // only signs and bins find room
  style.lamp_spacing_m = 11.0;
  return style;
}

/// Up to 1.4 m/s, with steps of 0.7 m, and of one tread on the stair.
std::shared_ptr<const Drive> stroll(std::uint64_t seed) {
  struct Stop {
    double time_s;
    double x, height, z;
    double yaw_deg, pitch_deg;
    double steps;
  };
  const std::vector<Stop> stops = {{0.0, -0.5, 0.0, 0.0, 0.0, -4.0, 0.0},
                                   {1.0, -0.5, 0.0, 0.0, 0.0, -4.0, 0.0},
                                   {4.2, -0.5, 0.0, 3.6, -28.0, 0.0, 5.0},
                                   {7.4, -0.4, 0.0, 7.8, 32.0, 4.0, 11.0},
                                   {10.2, -0.3, 0.0, 11.6, 0.0, -17.0, 16.0},
                                   {14.5, -0.2, 0.5 * kGain_m, 14.3, 4.0, -12.0, 24.0},
                                   {18.8, -0.2, kGain_m, 17.0, -3.0, 0.0, 32.0},
                                   {24.2, 0.0, kGain_m, kSideLane_m, 0.0, -3.0, 42.0},
                                   {24.8, 0.0, kGain_m, kSideLane_m, 0.0, -3.0, 42.0},
                                   // On the spot: round to the stair, and back to the side lane.
                                   {28.6, 0.0, kGain_m, kSideLane_m, 180.0, -8.0, 42.0},
                                   {29.4, 0.0, kGain_m, kSideLane_m, 180.0, -8.0, 42.0},
                                   {31.4, 0.0, kGain_m, kSideLane_m, 90.0, 0.0, 42.0},
                                   {34.8, 4.0, kGain_m, kSideLane_m - 0.3, 65.0, 18.0, 48.0},
                                   {38.0, 8.0, kGain_m, kSideLane_m - 0.4, 110.0, 2.0, 53.0},
                                   {41.6, 12.0, kGain_m, kSideLane_m - 0.2, 90.0, -6.0, 59.0},
                                   {42.4, 12.0, kGain_m, kSideLane_m - 0.2, 90.0, -6.0, 59.0}};
  std::vector<Waypoint> waypoints;
  for (const Stop& s : stops) {
    waypoints.push_back({s.time_s,
                         {s.x, -s.height - kNeck_m, s.z},
                         s.yaw_deg * kDegree,
                         s.pitch_deg * kDegree,
                         0.0,
                         s.steps});
  }
  Carrier walker;
  walker.drift_m = 0.006;
  walker.drift_rad = 0.8 * kDegree;
  walker.bob_m = 0.015;
  walker.sway_m = 0.012;
  walker.step_pitch_rad = 0.5 * kDegree;
  walker.step_turn_rad = 1.2 * kDegree;
  walker.camera = {-0.05, -0.1, 0.12};  // on the front of a helmet
  walker.seed = seed;
  return std::make_shared<FreeDrive>(std::move(waypoints), walker);
}

/// Stone with a bright strip along the edge of each tread.
class StepStone : public Material {
 public:
  explicit StepStone(const TextureTiles& tiles) : tiles_(tiles) {}

  double reflectance(const SurfacePoint& point) const override {
    const TexturePoint at = faceCoordinates(point);
    const double stone = 0.4 * (1.0 + 1.3 * (tiles_.asphalt.at(scaled(at, 3.1)) - 0.47) +
                                0.9 * (tiles_.plaster.at(scaled(at, 2.0)) - 0.5));
    if (point.normal.y() > -0.5) return stone;
    const double edge =
        coveragePeriodic(kTread_m, 0.045, at.at.y() - kFoot_m - 0.02, at.pixelHeight());
    return mix(stone, 0.7 + 0.6 * (stone - 0.4), edge);
  }

 private:
  const TextureTiles& tiles_;
};

Body makeStair(const TextureTiles& tiles) {
  const auto stone = std::make_shared<StepStone>(tiles);
  std::vector<Part> parts;
  for (int i = 0; i < kSteps; ++i) {
    parts.push_back({boxBetween({-kHalfWidth_m - 0.1, -kRise_m * (i + 1), kFoot_m + kTread_m * i},
                                {kHalfWidth_m + 0.1, 0.3, kTop_m}),
                     stone});
  }
  Body stair(std::move(parts));
  stair.is_ground = true;
  return stair;
}

/// A wall beside the stair whose top follows it, with a handrail on brackets at its inner side
/// (+x).
Body makeBanister(const TextureTiles& tiles) {
  constexpr double kAbove_m = 0.95;
  const double slope = kGain_m / (kTop_m - kFoot_m);
  auto wall = boxBetween({-0.3, -kGain_m - kAbove_m, kFoot_m - 0.4}, {0.0, 0.5, kTop_m + 0.4});
  wall->cut({0.0, -1.0, -slope}, {0.0, -kAbove_m, kFoot_m});
  return Body({{wall, std::make_shared<TexturedMaterial>(tiles.bricks, 0.42, 0.45)}});
}

Body makeHandrail() {
  const double half = 0.5 * std::hypot(kGain_m, kTop_m - kFoot_m);
  return Body({{std::make_shared<Cylinder>(2, Eigen::Vector3d::Zero(), 0.025, half),
                std::make_shared<PlainMaterial>(0.12)}});
}

class Lane {
 public:
  Lane(const TextureTiles& tiles, std::uint64_t seed) : tiles_(tiles), random_(seed, 0x3A1C) {}

  std::vector<Body> build() {
    bodies_.push_back(makeStair(tiles_));
    addBanisters();
    addEnds();
    for (double z = kBegin_m + 3.0; z < kEnd_m - 3.0; z += 2.6) {
      const bool on_stair = z > kFoot_m - 1.5 && z < kTop_m + 1.5;
      const bool at_corner = std::abs(z - kSideLane_m) < 4.5;
      if (!on_stair && !at_corner) addTub(z);
    }
    return std::move(bodies_);
  }

 private:
  void add(Body body, const Eigen::Vector3d& at, double heading_rad, double pitch_rad = 0.0) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = at;
    pose.rotate(Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitY()));
    pose.rotate(Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()));
    body.place(pose);
    bodies_.push_back(std::move(body));
  }

  void addBanisters() {
    const double slope_rad = std::atan2(kGain_m, kTop_m - kFoot_m);
    const double middle_m = 0.5 * (kFoot_m + kTop_m);
    for (const double side : {-1.0, 1.0}) {
      const double shift = side > 0.0 ? 0.3 : 0.0;
      add(makeBanister(tiles_), {side * kHalfWidth_m + shift, 0.0, 0.0}, 0.0);
      add(makeHandrail(),
          {side * (kHalfWidth_m - 0.08), -0.5 * kGain_m - 0.85, middle_m},
          0.0,
          slope_rad);
    }
    add(makeHandrail(), {0.75, -0.5 * kGain_m - 0.9, middle_m}, 0.0, slope_rad);
    for (int step = 1; step < kSteps; step += 5) {
      Body post({{std::make_shared<Cylinder>(1, Eigen::Vector3d(0.0, -0.45, 0.0), 0.02, 0.5),
                  std::make_shared<PlainMaterial>(0.12)}});
      add(std::move(post), {0.75, -kRise_m * (step + 1), kFoot_m + kTread_m * (step + 0.5)}, 0.0);
    }
  }

  /// Houses that close the lanes.
  void addEnds() {
    const HouseSize size{14.0, 9.0};
    add(makeHouse(size, tiles_, random_), {0.0, 0.0, kBegin_m - 5.0}, M_PI);
    add(makeHouse(size, tiles_, random_), {0.0, -kGain_m, kEnd_m + 5.0}, 0.0);
    add(makeHouse(size, tiles_, random_), {kSideEnd_m + 5.0, -kGain_m, kSideLane_m}, 0.5 * M_PI);
  }

  /// A tub with a bush, or a bin, at a house.
  void addTub(double z) {
    const double side = random_.chance(0.5) ? 1.0 : -1.0;
    const Eigen::Vector3d at(
        side * random_.uniform(2.5, 2.8), groundHeight(0.0, z), z + random_.uniform(-0.8, 0.8));
    const double what = random_.uniform(0.0, 1.0);
    if (what < 0.3) return;
    Body body =
        what < 0.5 ? makeBin(random_) : makeHedge(random_.uniform(0.7, 1.6), tiles_, random_);
    body.contact_shadow = true;
    body.own_shade = true;
    add(std::move(body), at, 0.5 * M_PI);
  }

  const TextureTiles& tiles_;
  RandomStream random_;
  std::vector<Body> bodies_;
};

}  // namespace

Scenario walk(std::uint64_t seed) {
  constexpr double kMargin_m = 60.0;
  Scenario scenario;
  scenario.drive = stroll(seed);
  scenario.traffic.oncoming_mps = 0.0;
  scenario.traffic.leader = false;
  WorldPlan& world = scenario.world;
  world.style = laneStyle();
  world.streets = {Path({{0.0, 0.0, kBegin_m}, {0.0, 0.0, kEnd_m}}),
                   Path({{3.0, 0.0, kSideLane_m}, {kSideEnd_m, 0.0, kSideLane_m}})};
  world.drives = {scenario.drive->path()};
  world.shadow_cell_m = 0.1;
  world.ground = GroundPlan{{Eigen::Vector2d(-kMargin_m, kBegin_m - kMargin_m),
                             Eigen::Vector2d(kSideEnd_m + kMargin_m, kEnd_m + kMargin_m)},
                            1.0,
                            groundHeight};
  world.furniture = [seed](const TextureTiles& tiles) { return Lane(tiles, seed).build(); };
  world.seed = seed;
  return scenario;
}

}  // namespace rotrocc
