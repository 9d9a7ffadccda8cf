#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/drives/drive.h"

namespace rotrocc {
namespace {

/// From 0 at 0 to 1 at 1, with zero slope and curvature at both ends.
double ease(double t) {
  return t * t * t * (t * (6.0 * t - 15.0) + 10.0);
}

/// The integral of ease() from 0 to t.
double easeIntegral(double t) {
  return t * t * t * t * (t * (t - 3.0) + 2.5);
}

double phaseDuration(const SpeedPhase& phase, double speed_before_mps) {
  return phase.distance_m == 0.0 ? 0.0
                                 : 2.0 * phase.distance_m / (speed_before_mps + phase.speed_mps);
}

/// Effect of an uneven road on a car at a station, between about -1 and 1; different for each kind.
double bump(double station_m, int kind) {
  double sum = 0.0;
  for (const double wavelength_m : {4.3, 7.1, 13.7}) {
    sum += std::sin(2.0 * M_PI * station_m / (wavelength_m * (1.0 + 0.13 * kind)) + 1.7 * kind);
  }
  return sum / 3.0;
}

}  // namespace

ScriptedDrive::ScriptedDrive(Path path,
                             std::vector<SpeedPhase> phases,
                             double initial_speed_mps,
                             const Sway& sway)
    : Drive(std::move(path)),
      phases_(std::move(phases)),
      initial_speed_mps_(initial_speed_mps),
      sway_(sway) {
  double speed = initial_speed_mps_;
  for (const SpeedPhase& phase : phases_) {
    duration_s_ += phaseDuration(phase, speed) + phase.stand_s;
    speed = phase.speed_mps;
  }
}

ScriptedDrive::Progress ScriptedDrive::progress(double time_s) const {
  if (time_s < 0.0) return {initial_speed_mps_ * time_s, initial_speed_mps_};
  double speed = initial_speed_mps_;
  double station = 0.0;
  for (const SpeedPhase& phase : phases_) {
    const double duration = phaseDuration(phase, speed);
    if (time_s < duration) {
      const double t = time_s / duration;
      return {station + duration * (speed * t + (phase.speed_mps - speed) * easeIntegral(t)),
              speed + (phase.speed_mps - speed) * ease(t)};
    }
    station += phase.distance_m;
    speed = phase.speed_mps;
    time_s -= duration + phase.stand_s;
    if (time_s < 0.0) return {station, speed};
  }
  return {station + speed * time_s, speed};
}

Eigen::Isometry3d ScriptedDrive::pose(double time_s) const {
  constexpr double kStep_s = 1e-3;
  constexpr double kStep_m = 0.5;
  const auto [station, speed] = progress(time_s);
  const double forward_mps2 =
      (progress(time_s + kStep_s).speed_mps - progress(time_s - kStep_s).speed_mps) /
      (2.0 * kStep_s);
  const double bend = std::remainder(
      path_.heading_rad(station + kStep_m) - path_.heading_rad(station - kStep_m), 2.0 * M_PI);
  const double right_mps2 = speed * speed * bend / (2.0 * kStep_m);

  const double slope = std::asin(-path_.direction(station).y());
  const double pitch = slope + sway_.pitch_rad_per_mps2 * forward_mps2 +
                       sway_.bump_rad * bump(station, 0) +
                       sway_.shake_pitch_rad * std::sin(2.0 * M_PI * 1.3 * time_s);
  const double roll = -sway_.roll_rad_per_mps2 * right_mps2 + sway_.bump_rad * bump(station, 1) +
                      sway_.shake_roll_rad * std::sin(2.0 * M_PI * 0.9 * time_s);
  const double yaw =
      path_.heading_rad(station) + sway_.look_yaw_rad * (std::sin(2.0 * M_PI * 0.6 * time_s) +
                                                         0.2 * std::sin(2.0 * M_PI * 1.9 * time_s));

  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = path_.position(station);
  pose.translation().y() += sway_.bump_m * bump(station, 2);
  pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
  pose.rotate(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()));  // positive: looks up
  pose.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));   // positive: right side down
  return pose;
}

}  // namespace rotrocc
