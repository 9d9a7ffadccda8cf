#include "simulation/drives/free_drive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "simulation/counter_random.h"
#include "simulation/drives/ease.h"
#include "simulation/drives/travelled_way.h"

namespace rotrocc {
namespace {

constexpr double kSampling_s = 0.02;  // of the way
constexpr int kAxes = 6;
constexpr int kWaves = 5;  // of the random motion of each axis
constexpr double kSlowest_hz = 0.1;
constexpr double kFastest_hz = 1.1;

std::vector<Waypoint> checked(std::vector<Waypoint> waypoints) {
  if (waypoints.size() < 2 || waypoints.front().time_s != 0.0) {
    throw std::invalid_argument("a motion of " + std::to_string(waypoints.size()) +
                                " waypoints: give at least two, from time 0 on");
  }
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    if (waypoints[i].time_s > waypoints[i - 1].time_s) continue;
    throw std::invalid_argument("waypoint " + std::to_string(i) + " is at " +
                                std::to_string(waypoints[i].time_s) +
                                " s, not after the one before: sort them by time");
  }
  return waypoints;
}

std::vector<double> sampleTimes(double duration_s) {
  std::vector<double> times_s;
  for (int i = 0; i * kSampling_s < duration_s; ++i) times_s.push_back(i * kSampling_s);
  times_s.push_back(duration_s);
  return times_s;
}

/// Slope at a point between two chords, without overshoot (Fritsch and Butland, 1984).
double slopeBetween(double before, double before_s, double after, double after_s) {
  if (before * after <= 0.0) return 0.0;
  const double weight_before = 2.0 * after_s + before_s;
  const double weight_after = after_s + 2.0 * before_s;
  return (weight_before + weight_after) / (weight_before / before + weight_after / after);
}

}  // namespace

FreeDrive::FreeDrive(std::vector<Waypoint> waypoints, const Carrier& carrier)
    : waypoints_(checked(std::move(waypoints))),
      carrier_(carrier),
      waves_(makeWaves(carrier.seed)),
      times_s_(sampleTimes(duration_s())),
      path_(pathThrough(positions())),
      stations_m_(stationsAlong(positions())) {}

std::vector<FreeDrive::Wave> FreeDrive::makeWaves(std::uint64_t seed) {
  RandomStream random(seed, 0xD21F);
  std::vector<Wave> waves;
  for (int i = 0; i < kAxes * kWaves; ++i) {
    const double frequency_hz = random.uniform(kSlowest_hz, kFastest_hz);
    waves.push_back({frequency_hz, random.uniform(0.0, 2.0 * M_PI)});
  }
  return waves;
}

std::vector<Eigen::Vector3d> FreeDrive::positions() const {
  std::vector<Eigen::Vector3d> positions;
  for (const double time_s : times_s_) positions.push_back(at(time_s).head<3>());
  return positions;
}

double FreeDrive::station_m(double time_s) const {
  const double time = std::clamp(time_s, 0.0, duration_s());
  const auto after = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, time);
  const auto i = static_cast<std::size_t>(after - times_s_.begin()) - 1;
  const double t = (time - times_s_[i]) / (times_s_[i + 1] - times_s_[i]);
  return stations_m_[i] + t * (stations_m_[i + 1] - stations_m_[i]);
}

FreeDrive::Coordinates FreeDrive::coordinates(std::size_t waypoint) const {
  const Waypoint& w = waypoints_[waypoint];
  Coordinates c;
  c << w.position, w.yaw_rad, w.pitch_rad, w.roll_rad, w.steps;
  return c;
}

/// At rest at both ends.
FreeDrive::Coordinates FreeDrive::velocity(std::size_t waypoint) const {
  Coordinates velocity = Coordinates::Zero();
  if (waypoint == 0 || waypoint + 1 == waypoints_.size()) return velocity;
  const double before_s = waypoints_[waypoint].time_s - waypoints_[waypoint - 1].time_s;
  const double after_s = waypoints_[waypoint + 1].time_s - waypoints_[waypoint].time_s;
  const Coordinates here = coordinates(waypoint);
  const Coordinates before = (here - coordinates(waypoint - 1)) / before_s;
  const Coordinates after = (coordinates(waypoint + 1) - here) / after_s;
  for (int i = 0; i < velocity.size(); ++i) {
    velocity[i] = slopeBetween(before[i], before_s, after[i], after_s);
  }
  return velocity;
}

/// A quintic between waypoints, without acceleration at them.
FreeDrive::Coordinates FreeDrive::at(double time_s) const {
  const double time = std::clamp(time_s, 0.0, duration_s());
  const auto after = std::upper_bound(
      waypoints_.begin() + 1, waypoints_.end() - 1, time, [](double t, const Waypoint& w) {
        return t < w.time_s;
      });
  const auto i = static_cast<std::size_t>(after - waypoints_.begin()) - 1;
  const double length_s = waypoints_[i + 1].time_s - waypoints_[i].time_s;
  const double t = (time - waypoints_[i].time_s) / length_s;
  const double leaving = t - t * t * t * (6.0 + t * (3.0 * t - 8.0));
  const double arriving = t * t * t * (t * (7.0 - 3.0 * t) - 4.0);
  const Coordinates from = coordinates(i);
  return from + ease(t) * (coordinates(i + 1) - from) +
         length_s * (leaving * velocity(i) + arriving * velocity(i + 1));
}

double FreeDrive::drift(int axis, double time_s) const {
  double sum = 0.0;
  for (int i = 0; i < kWaves; ++i) {
    const Wave& wave = waves_[static_cast<std::size_t>(axis * kWaves + i)];
    sum += std::sin(2.0 * M_PI * wave.frequency_hz * time_s + wave.phase_rad);
  }
  const double begun = ease(std::clamp(time_s - carrier_.still_s, 0.0, 1.0));
  return begun * sum * std::sqrt(2.0 / kWaves);
}

/// Pitch and roll of a multicopter: its thrust points where it accelerates.
Eigen::Vector2d FreeDrive::tilt(double time_s, double yaw_rad) const {
  constexpr double kResponse_s = 0.25;  // averages, so that the tilt turns smoothly
  constexpr double kGravity_mps2 = 9.81;
  const auto position = [&](double t) -> Eigen::Vector3d { return at(t).head<3>(); };
  const Eigen::Vector3d acceleration =
      (position(time_s + kResponse_s) - 2.0 * position(time_s) + position(time_s - kResponse_s)) /
      (kResponse_s * kResponse_s);
  const Eigen::Vector3d ahead(std::sin(yaw_rad), 0.0, std::cos(yaw_rad));
  const Eigen::Vector3d right(std::cos(yaw_rad), 0.0, -std::sin(yaw_rad));
  return carrier_.lean * Eigen::Vector2d(-std::atan(ahead.dot(acceleration) / kGravity_mps2),
                                         std::atan(right.dot(acceleration) / kGravity_mps2));
}

Eigen::Isometry3d FreeDrive::pose(double time_s) const {
  const Coordinates c = at(time_s);
  const double step = 2.0 * M_PI * c[6];
  const double side = std::sin(0.5 * step);
  const double yaw = c[3] + carrier_.step_turn_rad * side;
  const Eigen::Vector2d tilted = tilt(time_s, c[3]);
  const double pitch = c[4] + tilted[0] + carrier_.step_pitch_rad * std::sin(step);
  const double roll = c[5] + tilted[1] + carrier_.step_turn_rad * std::cos(0.5 * step);
  const Eigen::Vector3d right(std::cos(c[3]), 0.0, -std::sin(c[3]));

  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = c.head<3>() + carrier_.sway_m * side * right;
  pose.translation().y() += carrier_.bob_m * std::cos(step);
  for (int axis = 0; axis < 3; ++axis) {
    pose.translation()[axis] += carrier_.drift_m * drift(axis, time_s);
  }
  pose.rotate(
      Eigen::AngleAxisd(yaw + carrier_.drift_rad * drift(3, time_s), Eigen::Vector3d::UnitY()));
  pose.rotate(
      Eigen::AngleAxisd(pitch + carrier_.drift_rad * drift(4, time_s), Eigen::Vector3d::UnitX()));
  pose.rotate(
      Eigen::AngleAxisd(roll + carrier_.drift_rad * drift(5, time_s), Eigen::Vector3d::UnitZ()));
  return pose * Eigen::Translation3d(carrier_.camera);
}

}  // namespace rotrocc
