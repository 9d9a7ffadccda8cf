#pragma once

#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// What one pair gave, and what it cost without the reading of its images.
struct PairRecord {
  OdometryResult result;
  double wall_ms = 0.0;
  double cpu_ms = 0.0;  ///< of all threads of the process
};

/// A CSV table with a row for each pair: stamp, state, counts, times, the keyframe, the disparity
/// bias, the motion (rotation as axis times angle) and the upper triangle of its covariance, row by
/// row.
class StatisticsFile {
 public:
  /// Throws std::runtime_error if `path` cannot be written.
  explicit StatisticsFile(const std::string& path);

  /// Throws std::runtime_error when the disk is full or gone.
  void write(const PairRecord& record);

 private:
  std::string path_;
  std::ofstream file_;
};

/// The closing summary: pairs by state, and mean, median, 95th and 99th percentile of the times.
void printSummary(std::ostream& out, const std::vector<PairRecord>& records);

}  // namespace rotrocc
