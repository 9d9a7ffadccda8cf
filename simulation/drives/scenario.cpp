#include "simulation/drives/scenario.h"

#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "simulation/street/street_style.h"

namespace rotrocc {
namespace {

constexpr double kBeyond_m = 160.0;  // extension of the street before the start and after the end
constexpr double kSpacing_m = 0.5;   // between the points of a street
constexpr double kRight_rad = 0.5 * M_PI;

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
  Scenario scenario;
  scenario.world.streets = {drive->path().beside(-style.lane_m, kBeyond_m)};
  scenario.world.drives = {drive->path()};
  scenario.world.beyond_m = kBeyond_m;
  scenario.traffic.oncoming_m = -2.0 * style.lane_m;
  scenario.world.style = std::move(style);
  scenario.world.seed = seed;
  scenario.drive = std::move(drive);
  return scenario;
}

/// A street that branches off the path of a drive at a station, straight ahead or to a side.
Path sideStreet(const Path& path, double station_m, double angle_rad, double lane_m) {
  constexpr double kLength_m = 120.0;
  const Eigen::AngleAxisd turned(angle_rad, Eigen::Vector3d::UnitY());
  const Eigen::Vector3d direction = turned * path.direction(station_m);
  const Eigen::Vector3d start = path.position(station_m);
  return Path({start, start + kLength_m * Eigen::Vector3d(direction.x(), 0.0, direction.z())})
      .beside(-lane_m);
}

/// The centre lines of the streets along a path, `right_m` beside it and `beyond_m` longer at both
/// ends. Where the path comes within `same_street_m` of an earlier street, it reuses that street.
std::vector<Path> streetsAlong(const Path& path,
                               double right_m,
                               double beyond_m,
                               double same_street_m) {
  constexpr double kNeighbour_m = 40.0;  // least distance along a path between two passages
  constexpr double kMinLength_m = 10.0;  // of a street
  const Path line = path.beside(right_m, beyond_m);
  std::vector<Path> streets;
  std::vector<std::pair<Eigen::Vector3d, double>> passed;  // points with their stations
  std::vector<Eigen::Vector3d> points;                     // of the street that is being built
  const auto cameBy = [&](const Eigen::Vector3d& point, double station) {
    for (const auto& [other, other_station] : passed) {
      if (station - other_station < kNeighbour_m) return false;
      if (std::hypot(point.x() - other.x(), point.z() - other.z()) < same_street_m) return true;
    }
    return false;
  };
  const auto finish = [&] {
    if (static_cast<double>(points.size()) * kSpacing_m >= kMinLength_m)
      streets.emplace_back(points);
    points.clear();
  };
  for (double station = 0.0; station <= line.length_m(); station += kSpacing_m) {
    const Eigen::Vector3d point = line.position(station);
    if (cameBy(point, station)) {
      finish();
      continue;
    }
    passed.emplace_back(point, station);
    points.push_back(point);
  }
  finish();
  return streets;
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
  scenario.world.streets.push_back(sideStreet(drive->path(), first_turn, 0.0, lane));
  scenario.world.streets.push_back(sideStreet(drive->path(), second_turn, 0.0, lane));
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

Scenario shake(std::uint64_t seed) {
  constexpr double kDegree = M_PI / 180.0;
  const auto pieces = joined({{{80.0, 0.0}}, turn(0.4, 70.0, 15.0), {{90.0, 0.0}}});
  Sway sway;
  sway.shake_pitch_rad = 1.5 * kDegree;
  sway.shake_roll_rad = 2.5 * kDegree;
  auto drive = std::make_shared<ScriptedDrive>(
      layPath(pieces, hills), std::vector<SpeedPhase>{{200.0, 8.0}}, 8.0, sway);
  return alongOneStreet(drive, townStyle(), seed);
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

Scenario night(std::uint64_t seed) {
  Scenario scenario = city(seed);
  scenario.world.lighting = nightLighting();
  scenario.world.style.lamp_overhang_m = 2.0;  // all lamps
  scenario.exposure = {0.018, 8.0};
  return scenario;
}

using Maker = std::function<Scenario(std::uint64_t)>;

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> kMakers = {{"city", city},
                                                                     {"motorway", motorway},
                                                                     {"slip_road", slipRoad},
                                                                     {"parking", parking},
                                                                     {"shake", shake},
                                                                     {"handheld", handheld},
                                                                     {"night", night},
                                                                     {"hall", hall}};
  return kMakers;
}

}  // namespace

const std::vector<std::string>& scenarioNames() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& maker : makers()) names.push_back(maker.first);
    return names;
  }();
  return kNames;
}

Scenario scenario(const std::string& name, std::uint64_t seed) {
  for (const auto& [known, make] : makers()) {
    if (known == name) return make(seed);
  }
  const std::vector<std::string>& names = scenarioNames();
  throw std::invalid_argument(
      "there is no scenario '" + name + "': choose one of " +
      std::accumulate(names.begin() + 1,
                      names.end(),
                      names.front(),
                      [](const std::string& a, const std::string& b) { return a + ", " + b; }));
}

Scenario scenarioAlong(const Trajectory& trajectory, std::uint64_t seed) {
  constexpr double kSameStreet_m = 5.0;
  constexpr double kShortBeyond_m = 60.0;
  auto drive = std::make_shared<RecordedDrive>(trajectory);
  Scenario scenario = alongOneStreet(drive, townStyle(), seed);
  scenario.world.streets =
      streetsAlong(drive->path(), -scenario.world.style.lane_m, kShortBeyond_m, kSameStreet_m);
  for (const StampedPose& pose : trajectory) {
    scenario.stamps_ns.push_back(pose.stamp_ns - trajectory.front().stamp_ns);
  }
  return scenario;
}

}  // namespace rotrocc
