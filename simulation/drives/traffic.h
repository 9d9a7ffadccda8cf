#pragma once

#include <cstdint>
#include <vector>

#include "simulation/drives/drive.h"
#include "simulation/scene/body.h"
#include "simulation/scene/world.h"

namespace rotrocc {

/// Other moving cars. Distances are to the right of the camera's path.
struct TrafficPlan {
  double oncoming_m = -3.5;        ///< center of the oncoming lane
  double oncoming_mps = 9.0;       ///< 0: no oncoming traffic
  double overtaking_m = 0.0;       ///< middle of the lane of overtaking cars
  double overtaking_mps = 0.0;     ///< 0: nothing overtakes
  bool leader = true;              ///< a car drives ahead of the camera
  std::vector<double> meetings_s;  ///< at these times an oncoming car is met for certain
};

/// The moving cars of a drive.
class Traffic {
 public:
  /// `share`, 0 to 1, of the places for cars is taken. Drive and world must outlive it.
  Traffic(const TrafficPlan& plan,
          const Drive& drive,
          const World& world,
          double share,
          std::uint64_t seed);

  /// The cars that can be seen from the camera at a time.
  std::vector<Body> at(double time_s) const;

 private:
  struct Car {
    Body body;
    double right_m;
    double station_m;  // at time 0; for a leader: how far ahead of where the camera will be
    double speed_mps;  // along the path; negative: oncoming
    double lead_s;     // a leader is where the camera will be after that time; 0: no leader
  };

  double stationOf(const Car& car, double time_s) const;
  Eigen::Isometry3d poseAt(const Car& car, double station) const;

  const Drive& drive_;
  const World& world_;
  std::vector<Car> cars_;
};

}  // namespace rotrocc
