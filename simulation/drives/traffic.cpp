#include "simulation/drives/traffic.h"

#include <utility>

#include "simulation/counter_random.h"
#include "simulation/objects/objects.h"
#include "simulation/stress/lorry.h"

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
    : drive_(drive), world_(world), lorry_across_mps_(plan.lorry_across_mps) {
  RandomStream random(seed, 0x7AFF1C);
  const auto add = [&](double right, double station, double speed, double lead) {
    Body car = makeCar(random, true);
    if (random.chance(share)) cars_.push_back({std::move(car), right, station, speed, lead});
  };
  for (const double time : plan.meetings_s) {
    cars_.push_back({makeCar(random, true),
                     plan.oncoming_m,
                     drive.station_m(time) + plan.oncoming_mps * time,
                     -plan.oncoming_mps,
                     0.0});
  }
  if (plan.lorry) cars_.push_back({*plan.lorry, 0.0, kLorryAhead_m, 0.0, 0.0, true});
  if (plan.leader && share > 0.0) cars_.push_back({makeCar(random, true), 0.0, 9.5, 0.0, 1.6});
  if (plan.oncoming_mps > 0.0) {
    const double way_m = drive.path().length_m() + plan.oncoming_mps * drive.duration_s();
    for (double station = 20.0; station < way_m; station += kPlaceSpacing_m) {
      add(plan.oncoming_m, station + random.uniform(-8.0, 8.0), -plan.oncoming_mps, 0.0);
    }
  }
  if (plan.overtaking_mps > 0.0) {
    const double start_m =
        drive.path().length_m() - plan.overtaking_mps * drive.duration_s() - kVisible_m;
    for (double station = start_m; station < kVisible_m; station += 2.0 * kPlaceSpacing_m) {
      add(plan.overtaking_m, station, plan.overtaking_mps, 0.0);
    }
  }
}

double Traffic::stationOf(const Car& car, double time_s) const {
  if (car.with_camera) return drive_.station_m(time_s) + car.station_m;
  if (car.lead_s > 0.0) return drive_.station_m(time_s + car.lead_s) + car.station_m;
  return car.station_m + car.speed_mps * time_s;
}

Eigen::Isometry3d Traffic::poseWithCamera(const Car& car, double time_s) const {
  const Eigen::Isometry3d T_world_camera = drive_.pose(time_s);
  const double right_m = car.right_m + lorry_across_mps_ * (time_s - 0.5 * drive_.duration_s());
  const Eigen::Vector3d position = T_world_camera * Eigen::Vector3d(right_m, 0.0, car.station_m);
  const Eigen::Vector3d ahead = T_world_camera.linear().col(2);
  return world_.terrain().standing({position.x(), position.z()},
                                   Eigen::Vector3d(ahead.x(), 0.0, ahead.z()).normalized());
}

Eigen::Isometry3d Traffic::pose(int car, double time_s) const {
  const Car& moving = cars_[static_cast<std::size_t>(car)];
  if (moving.with_camera) return poseWithCamera(moving, time_s);
  const Path& path = drive_.path();
  const double station = stationOf(moving, time_s);
  const Eigen::Vector3d position = path.position(station) + moving.right_m * path.right(station);
  const double heading = path.heading_rad(station) + (moving.speed_mps < 0.0 ? M_PI : 0.0);
  return world_.terrain().lying({position.x(), position.z()},
                                {std::sin(heading), 0.0, std::cos(heading)});
}

MovingCars Traffic::at(double time_s) const {
  MovingCars moving;
  const double here = drive_.station_m(time_s);
  for (int i = 0; i < size(); ++i) {
    const Car& car = cars_[static_cast<std::size_t>(i)];
    if (std::abs(stationOf(car, time_s) - here) > kVisible_m) continue;
    Body body = car.body;
    body.place(pose(i, time_s));
    const Eigen::Vector3d& at = body.T_world_body().translation();
    body.lit = world_.lit(at.x(), at.z());
    moving.cars.push_back(i);
    moving.bodies.push_back(std::move(body));
  }
  return moving;
}

}  // namespace rotrocc
