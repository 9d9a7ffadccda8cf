#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/drives/drive.h"
#include "simulation/drives/traffic.h"
#include "simulation/scene/world.h"

namespace rotrocc {

struct Scenario {
  std::shared_ptr<const Drive> drive;
  WorldPlan world;
  TrafficPlan traffic;
  std::vector<std::int64_t> stamps_ns;  ///< of the frames; empty: at any rate
};

/// A scenario by name; throws std::invalid_argument, listing all names, if unknown.
///   city       300 m through a town with two turns and a stop
///   motorway   25 m/s on a nearly straight motorway, little texture near by
///   slip_road  a bend of 22 m radius at 10 m/s, 26 deg/s, through a meadow
///   parking    0.8 m/s in a car park, with a stop while a car passes close by
///   handheld   1.4 m/s along a town street, looking around with up to 120 deg/s
Scenario scenario(const std::string& name, std::uint64_t seed);

/// A town along a recorded drive, including hills. The frames have the stamps of the poses, from 0.
Scenario scenarioAlong(const Trajectory& trajectory, std::uint64_t seed);

}  // namespace rotrocc
