#pragma once

#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/trajectory.h"
#include "simulation/street/path.h"

namespace rotrocc {

/// Motion of the left camera. Poses are in the world of the simulation, where y points down.
class Drive {
 public:
  explicit Drive(Path path) : path_(std::move(path)) {}
  virtual ~Drive() = default;

  double duration_s() const { return duration_s_; }

  /// The path of the camera; it stays at its height above the ground.
  const Path& path() const { return path_; }

  /// Distance along the path; constant before the start and after the end.
  virtual double station_m(double time_s) const = 0;

  virtual Eigen::Isometry3d pose(double time_s) const = 0;  ///< T_world_camera

 protected:
  Path path_;
  double duration_s_ = 0.0;
};

/// A phase of a drive: the speed changes smoothly from that of the previous phase to its own.
struct SpeedPhase {
  double distance_m;
  double speed_mps;      ///< at its end
  double stand_s = 0.0;  ///< standstill at its end, if that speed is 0
};

/// Motion of the camera relative to the direction of the drive, as by a car's body or a hand.
struct Sway {
  double pitch_rad_per_mps2 = 0.004;  ///< its nose dips when it brakes
  double roll_rad_per_mps2 = 0.005;   ///< it leans out of a bend
  double bump_rad = 0.0012;           ///< amplitude of pitch and roll on an uneven road
  double bump_m = 0.006;              ///< amplitude of the height
  double shake_pitch_rad = 0.0;       ///< amplitude of pitch at 1.3 Hz
  double shake_roll_rad = 0.0;        ///< amplitude of roll at 0.9 Hz
  double look_yaw_rad = 0.0;          ///< amplitude of yaw at 0.6 Hz; a fifth of it at 1.9 Hz
};

class ScriptedDrive : public Drive {
 public:
  /// Starts with `initial_speed_mps` at the start of the path, which must be as long as the phases.
  /// A phase with a length must not begin and end at rest.
  ScriptedDrive(Path path,
                std::vector<SpeedPhase> phases,
                double initial_speed_mps,
                const Sway& sway);

  double station_m(double time_s) const override { return progress(time_s).station_m; }
  Eigen::Isometry3d pose(double time_s) const override;

 private:
  struct Progress {
    double station_m;
    double speed_mps;
  };
  Progress progress(double time_s) const;

  std::vector<SpeedPhase> phases_;
  double initial_speed_mps_;
  Sway sway_;
};

/// A recorded drive. Between its poses, before the first and after the last one the velocities are
/// constant: an exposure may begin and end there.
class RecordedDrive : public Drive {
 public:
  /// The stamps count from the first pose. Throws std::invalid_argument for poses within 1 m.
  explicit RecordedDrive(Trajectory trajectory);

  double station_m(double time_s) const override;
  Eigen::Isometry3d pose(double time_s) const override;

 private:
  struct Place {
    std::size_t index;
    double t;  // from 0 at pose `index` to 1 at the next; beyond them outside the recording
  };
  Place placeAt(double time_s) const;

  Trajectory trajectory_;
  std::vector<double> times_s_;
  std::vector<double> stations_m_;
};

}  // namespace rotrocc
