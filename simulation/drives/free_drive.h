#pragma once

#include <cstdint>
#include <vector>

#include "simulation/drives/drive.h"

namespace rotrocc {

/// A pose that a free motion passes. Angles are turned in this order: yaw, positive to the right,
/// pitch, positive upwards, roll, positive with the right side down.
struct Waypoint {
  double time_s;
  Eigen::Vector3d position;
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  double steps = 0.0;  ///< that a walker has made
};

/// What a motion adds to the way from waypoint to waypoint.
struct Carrier {
  double lean = 0.0;            ///< 1: tilts as a multicopter must, to accelerate; 0: never
  double drift_m = 0.0;         ///< slow random motion, one standard deviation of each axis
  double drift_rad = 0.0;       ///< the same of each angle
  double bob_m = 0.0;           ///< amplitude of the height with each step
  double sway_m = 0.0;          ///< amplitude to the side with each second step
  double step_pitch_rad = 0.0;  ///< amplitude with each step
  double step_turn_rad = 0.0;   ///< amplitude of yaw and roll with each second step
  Eigen::Vector3d camera = Eigen::Vector3d::Zero();  ///< from the point that turns, in its axes
  double still_s = 0.0;    ///< at the start, before the random motion begins
  std::uint64_t seed = 1;  ///< of the random motion
};

/// A motion in six degrees of freedom through waypoints. Acceleration and angular velocity are
/// continuous, there is no overshoot, and it rests between two waypoints at the same pose.
class FreeDrive : public Drive {
 public:
  /// Throws std::invalid_argument for fewer than two waypoints, times that do not rise from 0, or
  /// a motion that stays within 1 m.
  FreeDrive(std::vector<Waypoint> waypoints, const Carrier& carrier);

  double duration_s() const override { return waypoints_.back().time_s; }
  const Path& path() const override { return path_; }
  double station_m(double time_s) const override;
  Eigen::Isometry3d pose(double time_s) const override;

 private:
  using Coordinates = Eigen::Matrix<double, 7, 1>;  // position, yaw, pitch, roll, steps

  /// A sine of a random motion.
  struct Wave {
    double frequency_hz;
    double phase_rad;
  };

  static std::vector<Wave> makeWaves(std::uint64_t seed);
  std::vector<Eigen::Vector3d> positions() const;
  Coordinates coordinates(std::size_t waypoint) const;
  Coordinates velocity(std::size_t waypoint) const;
  Coordinates at(double time_s) const;
  double drift(int axis, double time_s) const;
  Eigen::Vector2d tilt(double time_s, double yaw_rad) const;

  std::vector<Waypoint> waypoints_;
  Carrier carrier_;
  std::vector<Wave> waves_;      // some for each axis
  std::vector<double> times_s_;  // of the samples of the way
  Path path_;
  std::vector<double> stations_m_;  // at these times
};

}  // namespace rotrocc
