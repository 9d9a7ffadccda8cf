#include "simulation/drives/traffic.h"

#include <utility>

#include "simulation/counter_random.h"
#include "simulation/objects/objects.h"

namespace rotrocc {
namespace {

constexpr double kVisible_m = 220.0;
constexpr double kPlaceSpacing_m = 25.0;  // between places for cars

}  // namespace

Traffic::Traffic(const TrafficPlan& plan,
                 const Drive& drive,
                 const World& world,
                 double share,
                 std::uint64_t seed)
    : drive_(drive), world_(world) {
  RandomStream random(seed, 0x7AFF1C);
  const auto add = [&](double right, double station, double speed) {
    Body car = makeCar(random);
    if (random.chance(share)) cars_.push_back({std::move(car), right, station, speed, 0.0});
  };
  for (const double time : plan.meetings_s) {
    cars_.push_back({makeCar(random),
                     plan.oncoming_m,
                     drive.station_m(time) + plan.oncoming_mps * time,
                     -plan.oncoming_mps,
                     0.0});
  }
  if (plan.leader && share > 0.0) cars_.push_back({makeCar(random), 0.0, 9.5, 0.0, 1.6});
  if (plan.oncoming_mps > 0.0) {
    const double way_m = drive.path().length_m() + plan.oncoming_mps * drive.duration_s();
    for (double station = 20.0; station < way_m; station += kPlaceSpacing_m) {
      add(plan.oncoming_m, station + random.uniform(-8.0, 8.0), -plan.oncoming_mps);
    }
  }
  if (plan.overtaking_mps > 0.0) {
    const double start_m =
        drive.path().length_m() - plan.overtaking_mps * drive.duration_s() - kVisible_m;
    for (double station = start_m; station < kVisible_m; station += 2.0 * kPlaceSpacing_m) {
      add(plan.overtaking_m, station, plan.overtaking_mps);
    }
  }
}

double Traffic::stationOf(const Car& car, double time_s) const {
  if (car.lead_s > 0.0) return drive_.station_m(time_s + car.lead_s) + car.station_m;
  return car.station_m + car.speed_mps * time_s;
}

/// T_world_car.
Eigen::Isometry3d Traffic::poseAt(const Car& car, double station) const {
  const Path& path = drive_.path();
  const Eigen::Vector3d position = path.position(station) + car.right_m * path.right(station);
  const double heading = path.heading_rad(station) + (car.speed_mps < 0.0 ? M_PI : 0.0);
  return world_.terrain().lying({position.x(), position.z()},
                                {std::sin(heading), 0.0, std::cos(heading)});
}

std::vector<Body> Traffic::at(double time_s) const {
  std::vector<Body> visible;
  const double here = drive_.station_m(time_s);
  for (const Car& car : cars_) {
    const double station = stationOf(car, time_s);
    if (std::abs(station - here) > kVisible_m) continue;
    Body body = car.body;
    body.place(poseAt(car, station));
    const Eigen::Vector3d& at = body.T_world_body().translation();
    body.lit = world_.lit(at.x(), at.z());
    visible.push_back(std::move(body));
  }
  return visible;
}

}  // namespace rotrocc
