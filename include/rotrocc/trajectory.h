#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace rotrocc {

/// A pose with a stamp: `T_world_body` maps points of the moving frame to the frame of the first
/// pose.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
};

using Trajectory = std::vector<StampedPose>;

/// The two common text formats for trajectories:
///   kKitti: 12 numbers per line, the rows of the 3x4 pose matrix (KITTI odometry devkit).
///   kTum:   `stamp[s] tx ty tz qx qy qz qw` on each line (TUM RGB-D benchmark).
enum class TrajectoryFormat { kKitti, kTum };

/// The format named "kitti" or "tum". Throws std::invalid_argument on any other name.
TrajectoryFormat trajectoryFormat(const std::string& name);

/// The format of an existing file, identified by the number of values in its first line of data.
/// Throws std::runtime_error if the file does not exist, has no data or is in neither format.
TrajectoryFormat detectTrajectoryFormat(const std::string& path);

/// Reads either format and its relatives. Blank lines, lines that begin with '#', and a header are
/// skipped; numbers may be separated by commas.
///   12 or 16 numbers    a matrix, 3x4 (KITTI) or 4x4, row by row; they get 0, 0.1, 0.2 ... s
///   13                  a time and a 3x4 matrix
///   8                   TUM: a time, position, quaternion x y z w; with commas and times in ns as
///                       in ASL's (mocap0/data.csv), w x y z
///   17                  ASL (state_groundtruth_estimate0/data.csv)
/// Times are seconds, or what their digits imply if they count from 1970.
///
/// An orthonormality error of up to 1e-3, from rounding, is removed. Throws std::runtime_error with
/// file and line on any pose that is not finite and rigid, on stamps that do not increase, and on a
/// file without poses.
Trajectory readTrajectory(const std::string& path);

/// Reads a file with one time of an image per line, rounded to nanoseconds: seconds (KITTI's
/// times.txt), seconds to nanoseconds since 1970, or date and time (KITTI's
/// timestamps.txt). Throws std::runtime_error with file and line on any other content, on times
/// that do not increase, and on steps that no camera has, with the unit that would fit.
std::vector<std::int64_t> readTimes(const std::string& path);

/// The first pose that is not before a stamp. Stamps must increase.
Trajectory::const_iterator firstFrom(const Trajectory& trajectory, std::int64_t stamp_ns);

/// The pose at a stamp, between the poses before and after it if these are at most `max_gap_ns`
/// apart; none outside of the trajectory and in longer gaps. Stamps must increase.
std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory,
                                        std::int64_t stamp_ns,
                                        std::int64_t max_gap_ns);

/// The poses at those stamps that have one, across gaps of up to 0.1 s: recorded ground truth has
/// 10 Hz (KITTI) to 200 Hz (EuRoC).
Trajectory samplePoses(const Trajectory& trajectory, const std::vector<std::int64_t>& stamps_ns);

/// Writes poses one by one. Each line is in the file before write() returns. KITTI lines have 10
/// significant digits, like KITTI's own files, TUM lines 9 decimals and qw >= 0.
class TrajectoryWriter {
 public:
  /// Replaces the file. `body`, e.g. "base_link", is named in a comment where the format has
  /// comments. Throws std::runtime_error if `path` cannot be written.
  TrajectoryWriter(const std::string& path, TrajectoryFormat format, const std::string& body = "");

  /// Throws std::runtime_error if writing fails, e.g. when the disk is full.
  void write(const StampedPose& pose);

 private:
  std::string path_;
  TrajectoryFormat format_;
  std::ofstream file_;
};

}  // namespace rotrocc
