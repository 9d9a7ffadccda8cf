#include "simulation/drives/scenario.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace rotrocc {
namespace {

constexpr double kBeyond_m = 160.0;  // extension of the street before the start and after the end
constexpr double kRight_rad = 0.5 * M_PI;
constexpr double kFar_m = 1000.0;

Marking line(double right_m, double width_m) {
  return {right_m, width_m, 1.0, 1.0};
}

/// A street in a town: parked cars, pavements, houses.
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

/// One half of a motorway with the other beyond a guard rail, between woods.
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

/// A single lane through a meadow.
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

/// Rows of cars parked at right angles, with houses around.
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

std::vector<PathPiece> joined(const std::vector<std::vector<PathPiece>>& groups) {
  std::vector<PathPiece> pieces;
  for (const auto& group : groups) pieces.insert(pieces.end(), group.begin(), group.end());
  return pieces;
}

double level(double /*station_m*/) {
  return 0.0;
}

double hills(double station_m) {
  return 0.5 * (1.0 - std::cos(2.0 * M_PI * station_m / 130.0));
}

/// The street of a path, with its extensions.
Scenario alongOneStreet(std::shared_ptr<const Drive> drive, StreetStyle style, std::uint64_t seed) {
  TrafficPlan traffic;
  traffic.oncoming_m = -2.0 * style.lane_m;
  const Path street = drive->path().beside(-style.lane_m, kBeyond_m);
  WorldPlan world = {{street}, drive->path(), kBeyond_m, std::move(style), {}, seed};
  return {std::move(drive), std::move(world), traffic, {}};
}

/// A street that goes straight on where the path of a drive bends.
Path sideStreet(const Path& path, double station_m, double lane_m) {
  constexpr double kLength_m = 120.0;
  const Eigen::Vector3d direction = path.direction(station_m);
  const Eigen::Vector3d start = path.position(station_m);
  return Path({start, start + kLength_m * Eigen::Vector3d(direction.x(), 0.0, direction.z())})
      .beside(-lane_m);
}

Scenario city(std::uint64_t seed) {
  const auto pieces = joined({{{30.0, 0.0}},
                              turn(-0.22, 60.0, 6.0),
                              {{20.0, 0.0}},
                              turn(kRight_rad, 11.0, 7.0),
                              {{76.0, 0.0}},
                              turn(-kRight_rad, 12.5, 7.0),
                              {{34.0, 0.0}},
                              turn(0.3, 55.0, 8.0),
                              {{46.0, 0.0}}});
  const std::vector<SpeedPhase> phases = {{36.0, 9.0},
                                          {10.0, 9.0},
                                          {17.0, 5.0},
                                          {31.0, 5.0},
                                          {18.0, 9.5},
                                          {16.0, 9.5},
                                          {26.0, 0.0, 2.5},
                                          {19.0, 5.5},
                                          {27.0, 5.5},
                                          {25.0, 10.0},
                                          {50.0, 10.0},
                                          {25.0, 0.0, 1.0}};
  auto drive = std::make_shared<ScriptedDrive>(layPath(pieces, hills), phases, 0.0, Sway());
  Scenario scenario = alongOneStreet(drive, townStyle(), seed);
  const double lane = scenario.world.style.lane_m;
  const double first_turn = 62.0;
  const double second_turn = 170.0;
  scenario.world.streets.push_back(sideStreet(drive->path(), first_turn, lane));
  scenario.world.streets.push_back(sideStreet(drive->path(), second_turn, lane));
  scenario.world.crossings = {
      {0, kBeyond_m + 156.5, true}, {0, kBeyond_m + 155.3, false}, {0, kBeyond_m + 40.0, true}};
  return scenario;
}

Scenario motorway(std::uint64_t seed) {
  const auto pieces = joined({{{200.0, 0.0}},
                              turn(0.25, 900.0, 120.0),
                              {{150.0, 0.0}},
                              turn(-0.3, 800.0, 120.0),
                              {{250.0, 0.0}}});
  auto drive = std::make_shared<ScriptedDrive>(
      layPath(pieces, hills), std::vector<SpeedPhase>{{1000.0, 25.0}}, 25.0, Sway());
  Scenario scenario = alongOneStreet(drive, motorwayStyle(), seed);
  scenario.traffic.oncoming_m = -14.5;
  scenario.traffic.oncoming_mps = 28.0;
  scenario.traffic.overtaking_m = -3.75;
  scenario.traffic.overtaking_mps = 31.0;
  return scenario;
}

Scenario slipRoad(std::uint64_t seed) {
  constexpr double kSpeed_mps = 10.0;
  constexpr double kTurnRate_rps = 26.0 * M_PI / 180.0;
  const auto pieces =
      joined({{{40.0, 0.0}}, turn(3.9, kSpeed_mps / kTurnRate_rps, 20.0), {{60.0, 0.0}}});
  auto drive = std::make_shared<ScriptedDrive>(
      layPath(pieces, level), std::vector<SpeedPhase>{{180.0, kSpeed_mps}}, kSpeed_mps, Sway());
  Scenario scenario = alongOneStreet(drive, rampStyle(), seed);
  scenario.traffic.oncoming_mps = 0.0;
  return scenario;
}

Scenario parking(std::uint64_t seed) {
  const auto pieces = joined({{{9.0, 0.0}}, turn(kRight_rad, 7.0, 4.0), {{12.0, 0.0}}});
  const std::vector<SpeedPhase> phases = {
      {1.0, 0.8}, {9.0, 0.8}, {1.0, 0.0, 6.0}, {1.0, 0.8}, {14.0, 0.8}, {1.0, 0.0, 1.0}};
  auto drive = std::make_shared<ScriptedDrive>(layPath(pieces, level), phases, 0.0, Sway());
  Scenario scenario = alongOneStreet(drive, carParkStyle(), seed);
  scenario.traffic.oncoming_m = -2.4;
  scenario.traffic.oncoming_mps = 3.0;
  scenario.traffic.meetings_s = {19.0};
  scenario.traffic.leader = false;
  return scenario;
}

Scenario handheld(std::uint64_t seed) {
  constexpr double kDegree = M_PI / 180.0;
  const auto pieces = joined({{{20.0, 0.0}}, turn(0.4, 30.0, 8.0), {{25.0, 0.0}}});
  Sway sway;
  sway.shake_pitch_rad = 4.0 * kDegree;
  sway.shake_roll_rad = 5.0 * kDegree;
  sway.look_yaw_rad = 18.0 * kDegree;
  sway.bump_m = 0.02;  // steps
  auto drive = std::make_shared<ScriptedDrive>(
      layPath(pieces, level), std::vector<SpeedPhase>{{56.0, 1.4}}, 1.4, sway);
  return alongOneStreet(drive, townStyle(), seed);
}

}  // namespace

Scenario scenario(const std::string& name, std::uint64_t seed) {
  const std::pair<const char*, Scenario (*)(std::uint64_t)> makers[] = {{"city", city},
                                                                        {"motorway", motorway},
                                                                        {"slip_road", slipRoad},
                                                                        {"parking", parking},
                                                                        {"handheld", handheld}};
  std::string names;
  for (const auto& [known, make] : makers) {
    if (known == name) return make(seed);
    names += names.empty() ? known : std::string(", ") + known;
  }
  throw std::invalid_argument("there is no scenario '" + name + "': choose one of " + names);
}

Scenario scenarioAlong(const Trajectory& trajectory, std::uint64_t seed) {
  constexpr double kShortBeyond_m = 60.0;
  constexpr double kSpacing_m = 0.5;  // between the points of the street
  auto drive = std::make_shared<RecordedDrive>(trajectory);
  Scenario scenario = alongOneStreet(drive, townStyle(), seed);
  const Path street = drive->path().beside(-scenario.world.style.lane_m, kShortBeyond_m);
  std::vector<Eigen::Vector3d> points;
  for (double station = 0.0; station <= street.length_m(); station += kSpacing_m) {
    points.push_back(street.position(station));
  }
  scenario.world.streets = {Path(std::move(points))};
  for (const StampedPose& pose : trajectory) {
    scenario.stamps_ns.push_back(pose.stamp_ns - trajectory.front().stamp_ns);
  }
  return scenario;
}

}  // namespace rotrocc
