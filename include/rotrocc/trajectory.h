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

/// Reads either format, told apart by the numbers in the first line; blank lines and lines that begin
/// with '#' are skipped. KITTI poses have no stamps: they get 0, 1, 2 ... s unless `times_path` names a
/// file with a time [s] a line.
/// Throws std::runtime_error with file and line on anything that is not a rigid finite pose.
Trajectory readTrajectory(const std::string& path, const std::string& times_path = "");

/// Writes poses one by one, each line complete on disk when write() returns, so that nothing is lost
/// when the program is stopped.
class TrajectoryWriter {
 public:
  /// Throws std::runtime_error if `path` cannot be written.
  TrajectoryWriter(const std::string& path, TrajectoryFormat format);

  /// Throws std::runtime_error when the disk is full or gone.
  void write(const StampedPose& pose);

 private:
  std::string path_;
  TrajectoryFormat format_;
  std::ofstream file_;
};

}  // namespace rotrocc
