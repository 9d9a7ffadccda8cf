#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/trajectory.h"
#include "simulation/street/path.h"

namespace rotrocc {

/// Motion of the left camera. Poses are in the world of the simulation, where y points down.
class Drive {
 public:
  virtual ~Drive() = default;

  virtual double duration_s() const = 0;

  /// The path of the camera; it stays at its height above the ground.
  virtual const Path& path() const = 0;

  /// Distance along the path; constant before the start and after the end.
  virtual double station_m(double time_s) const = 0;

  /// T_world_camera.
  virtual Eigen::Isometry3d pose(double time_s) const = 0;
};

/// A phase of a drive: the speed changes smoothly, with continuous acceleration, from that of the
/// previous phase to its own.
struct SpeedPhase {
  double distance_m;
  double speed_mps;      ///< at its end
  double stand_s = 0.0;  ///< standstill at its end, if that speed is 0
};

/// Motion of the camera relative to the direction of the drive, as by the body of a car or by a
/// hand.
struct Sway {
  double pitch_rad_per_mps2 = 0.004;  ///< its nose dips when it brakes
  double roll_rad_per_mps2 = 0.005;   ///< it leans out of a bend
  double bump_rad = 0.0012;           ///< amplitude of pitch and roll on an uneven road
  double bump_m = 0.006;              ///< amplitude of the height
  double shake_pitch_rad = 0.0;       ///< amplitude of pitch at 1.3 Hz
  double shake_roll_rad = 0.0;        ///< amplitude of roll at 0.9 Hz
  double look_yaw_rad = 0.0;          ///< amplitude of yaw at 0.6 Hz; a fifth of it at 1.9 Hz
};

/// A drive along a path with given speed phases.
class ScriptedDrive : public Drive {
 public:
  /// Starts with `initial_speed_mps` at the start of the path, which must be as long as the phases.
  /// A phase with a length must not begin and end at rest.
  ScriptedDrive(Path path,
                std::vector<SpeedPhase> phases,
                double initial_speed_mps,
                const Sway& sway);

  double duration_s() const override { return duration_s_; }
  const Path& path() const override { return path_; }
  double station_m(double time_s) const override;
  Eigen::Isometry3d pose(double time_s) const override;

 private:
  double speed_mps(double time_s) const;

  Path path_;
  std::vector<SpeedPhase> phases_;
  double initial_speed_mps_;
  Sway sway_;
  double duration_s_ = 0.0;
};

/// A recorded drive, with smooth interpolation between its poses. Before the first and after the
/// last one it goes on at the same velocity: an exposure may begin and end there.
class RecordedDrive : public Drive {
 public:
  /// The stamps count from the first pose. Throws std::invalid_argument for fewer than two poses,
  /// or poses without motion.
  explicit RecordedDrive(Trajectory trajectory);

  double duration_s() const override { return times_s_.back(); }
  const Path& path() const override { return path_; }
  double station_m(double time_s) const override;
  Eigen::Isometry3d pose(double time_s) const override;

 private:
  /// The poses before and after one.
  struct Difference {
    const Eigen::Isometry3d& before;
    const Eigen::Isometry3d& after;
    double length_s;
  };
  Difference differenceAt(std::size_t pose) const;
  Eigen::Vector3d velocity(std::size_t pose) const;
  Eigen::Vector3d rate(std::size_t pose) const;
  std::size_t intervalAt(double time_s) const;
  Eigen::Isometry3d between(double time_s) const;

  Trajectory trajectory_;
  std::vector<double> times_s_;
  Path path_;
  std::vector<double> stations_m_;
};

}  // namespace rotrocc
