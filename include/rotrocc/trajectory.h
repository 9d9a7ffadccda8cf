#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace rotrocc {

/// A pose at a time: `T_world_body` maps points of the moving frame to the frame of the first pose.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
};

using Trajectory = std::vector<StampedPose>;

/// The two text formats every evaluation tool reads.
///   kKitti: 12 numbers a line, the rows of the 3x4 pose matrix (KITTI odometry devkit).
///   kTum:   `stamp[s] tx ty tz qx qy qz qw` a line (TUM RGB-D benchmark).
enum class TrajectoryFormat { kKitti, kTum };

/// "kitti" or "tum"; throws std::invalid_argument on anything else.
TrajectoryFormat trajectoryFormat(const std::string& name);

/// The format of an existing file, told by the count of numbers in its first line of data.
/// Throws std::runtime_error if there is no such file, it has no data or it is neither format.
TrajectoryFormat detectTrajectoryFormat(const std::string& path);

/// Reads either format; blank lines and lines that begin with '#' are skipped. KITTI poses have no
/// stamps: they get those of the file `times_path` (see readTimes(), at least one for each pose),
/// or 0, 0.1, 0.2 ... s, the rate of KITTI, if it is empty. Rotations are printed with few digits:
/// an orthonormality error up to 1e-3 is taken as rounding and removed, so what is returned is
/// rigid. Throws std::runtime_error with file and line on anything that is not a rigid finite pose,
/// on stamps that do not increase, on a file without poses, and on a times file for poses that have
/// stamps.
Trajectory readTrajectory(const std::string& path, const std::string& times_path = "");

/// Reads a file with one time [s] a line (KITTI's times.txt), rounded to nanoseconds.
/// Throws std::runtime_error with file and line on anything else and on times that do not increase.
std::vector<std::int64_t> readTimes(const std::string& path);

/// Writes poses one by one, each line complete on disk when write() returns, so that nothing is
/// lost when the program is stopped. KITTI lines have 10 significant digits as KITTI's own; TUM
/// lines have 9 decimals (stamps exact, positions to the nanometre) and qw >= 0.
class TrajectoryWriter {
 public:
  /// Replaces the file. Throws std::runtime_error if `path` cannot be written.
  TrajectoryWriter(const std::string& path, TrajectoryFormat format);

  /// Throws std::runtime_error when the disk is full or gone.
  void write(const StampedPose& pose);

 private:
  std::string path_;
  TrajectoryFormat format_;
  std::ofstream file_;
};

}  // namespace rotrocc
