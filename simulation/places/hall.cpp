#include "simulation/places/hall.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "simulation/drives/free_drive.h"
#include "simulation/places/hall_furnishing.h"
#include "simulation/places/interior.h"
#include "simulation/scene/lamps.h"

namespace rotrocc {
namespace {

constexpr double kDegree = M_PI / 180.0;

struct FlightPoint {
  double time_s;
  double x, height, z;
  double yaw_deg;
};

/// Two waypoints at one place are a hover.
std::shared_ptr<const Drive> flight(std::uint64_t seed) {
  constexpr double kLooksDown_rad = -6.0 * kDegree;
  const std::vector<FlightPoint> points = {{0.0, 0.0, 0.25, 0.0, 0.0},
                                           {1.0, 0.0, 0.25, 0.0, 0.0},  // take-off
                                           {3.2, 0.0, 1.5, 0.0, 0.0},
                                           {5.0, 0.0, 1.5, 0.0, 0.0},
                                           {8.6, 0.3, 1.7, 7.5, 0.0},
                                           {9.2, 0.3, 1.7, 7.5, 0.0},
                                           {12.5, 0.3, 1.7, 7.5, 180.0},
                                           {13.0, 0.3, 1.7, 7.5, 180.0},  // turned by 100 deg/s
                                           {15.6, -4.5, 2.0, 3.0, 225.0},
                                           {17.6, -7.4, 1.8, 1.6, 325.0},
                                           {19.2, -7.5, 1.7, 4.5, 330.0},
                                           {22.2, -7.5, 1.6, 11.5, 335.0},  // along the wall
                                           {24.3, -5.0, 2.4, 15.5, 375.0},
                                           {26.6, 0.0, 3.0, 17.2, 460.0},
                                           {28.8, 4.2, 2.2, 13.0, 540.0},
                                           {31.0, 4.6, 1.5, 7.0, 540.0},
                                           {32.5, 4.6, 1.5, 7.0, 540.0}};
  std::vector<Waypoint> waypoints;
  for (const FlightPoint& p : points) {
    waypoints.push_back(
        {p.time_s, {p.x, -p.height, p.z}, p.yaw_deg * kDegree, kLooksDown_rad, 0.0, 0.0});
  }
  Carrier multicopter;
  multicopter.lean = 1.0;
  multicopter.drift_m = 0.02;
  multicopter.drift_rad = 0.6 * kDegree;
  multicopter.still_s = 1.0;
  multicopter.seed = seed;
  return std::make_shared<FreeDrive>(std::move(waypoints), multicopter);
}

}  // namespace

Scenario hall(std::uint64_t seed) {
  constexpr double kReach_m = 14.0;
  constexpr double kAmbient = 0.24;
  Scenario scenario;
  scenario.drive = flight(seed);
  scenario.traffic.oncoming_mps = 0.0;
  scenario.traffic.leader = false;
  WorldPlan& world = scenario.world;
  world.light = std::make_shared<Lamps>(hallLamps(), kReach_m, kAmbient);
  world.lighting.lights = 1.0;
  world.shadow_cell_m = 0.1;
  world.under_sky = false;
  world.ground = GroundPlan{{Eigen::Vector2d(HallWalls::kLeft_m, HallWalls::kBack_m),
                             Eigen::Vector2d(HallWalls::kRight_m, HallWalls::kFront_m)},
                            2.0,
                            [](double, double) { return 0.0; }};
  world.floor = [](const TextureTiles& tiles) { return std::make_shared<HallFloor>(tiles); };
  world.furniture = [drive = scenario.drive, seed](const TextureTiles& tiles) {
    return furnishHall(*drive, tiles, seed);
  };
  world.seed = seed;
  return scenario;
}

}  // namespace rotrocc
