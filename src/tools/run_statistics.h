#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "common/csv_file.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// Result and times of one pair, without reading its images.
struct PairRecord {
  OdometryResult result;
  double wall_ms = 0.0;  ///< of VisualOdometry::prepare() and process()
  double cpu_ms = 0.0;   ///< all threads of the process
};

/// CSV table with one row per pair: stamp, state, counts, times, the keyframe, the disparity bias,
/// the motion (rotation as axis times angle) and the upper triangle of its covariance, row by row.
class StatisticsFile {
 public:
  /// Throws std::runtime_error if `path` cannot be written.
  explicit StatisticsFile(const std::string& path);

  /// Throws std::runtime_error if writing fails, e.g. on a full disk.
  void write(const PairRecord& record);

 private:
  CsvFile file_;
};

/// Summary of a run: pairs by state, and mean, median, 95th and 99th percentile of the times.
void printSummary(std::ostream& out, const std::vector<PairRecord>& records);

}  // namespace rotrocc
