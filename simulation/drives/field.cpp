#include "simulation/drives/field.h"

#include <cmath>
#include <utility>

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// Slow waves of the track.
double waves(double station_m) {
  return 0.12 * std::sin(2.0 * M_PI * station_m / 23.0) +
         0.05 * std::sin(2.0 * M_PI * station_m / 11.0 + 1.0);
}

std::vector<PathPiece> track() {
  std::vector<PathPiece> pieces = {{9.0, 0.0}};
  for (const auto& [angle_rad, radius_m] : {std::pair(0.5, 9.0), std::pair(-0.7, 7.0)}) {
    const auto bend = turn(angle_rad, radius_m, 2.0);
    pieces.insert(pieces.end(), bend.begin(), bend.end());
    pieces.push_back({9.0, 0.0});
  }
  return pieces;
}

Sway roverSway() {
  Sway sway;
  sway.look_down_rad = 8.0 * kDegree;
  sway.bump_rad = 3.0 * kDegree;
  sway.bump_m = 0.02;
  sway.bump_scale = 0.2;  // waves of 0.9 to 2.7 m
  return sway;
}

}  // namespace

Scenario field(std::uint64_t seed) {
  constexpr double kBeyond_m = 160.0;
  constexpr double kSpacing_m = 0.5;
  const auto drive = std::make_shared<ScriptedDrive>(
      layPath(track(), waves),
      std::vector<SpeedPhase>{{8.0, 0.5}, {4.0, 0.9}, {12.0, 0.9}, {4.0, 0.6}, {6.0, 0.6}},
      0.7,
      roverSway());
  Scenario scenario;
  scenario.world.streets = {drive->path().beside(0.0, kSpacing_m, kBeyond_m, kBeyond_m)};
  scenario.world.drives = {drive->path()};
  scenario.world.beyond_m = kBeyond_m;
  scenario.world.style = fieldStyle();
  scenario.world.camera_height_m = 0.65;
  scenario.world.cell_m = 2.0;
  scenario.world.rough_m = 0.05;
  scenario.world.seed = seed;
  scenario.traffic.oncoming_mps = 0.0;
  scenario.traffic.leader = false;
  scenario.drive = drive;
  return scenario;
}

}  // namespace rotrocc
