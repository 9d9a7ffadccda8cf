#pragma once

#include <string>
#include <vector>

#include "rotrocc/trajectory_error.h"

namespace rotrocc {

constexpr double kDegreesPerRadian = 57.295779513082321;

struct Evaluation {
  MatchedTrajectories matched;
  std::vector<double> path_m;  ///< along the ground truth, to each pose
  std::vector<SegmentError> segments;
  MeanError mean;
  std::vector<MeanError> by_length;
  std::vector<MeanError> by_speed;
  std::vector<StepError> steps;
  Drift drift;
};

/// Throws std::invalid_argument like segmentErrors().
Evaluation evaluate(MatchedTrajectories matched, const SegmentConfig& segments);

/// Writes a CSV table with one row per segment. Throws std::runtime_error if that fails.
void writeSegments(const std::vector<SegmentError>& segments, const std::string& path);

/// Writes the tables of a report into a ReportDirectory:
///   summary.csv     one row: poses, path, mean errors, errors of steps, drift
///   poses.csv       stamp, path, true and estimated position, each in the frame of its first pose,
///                   and the error of the step that led there (nan for the first)
///   segments.csv, by_length.csv, by_speed.csv    the metric of the KITTI devkit
/// Throws std::runtime_error if they cannot be written, and as ReportDirectory.
void writeReportTables(const Evaluation& evaluation, const std::string& directory);

/// The same without ground truth: summary.csv and poses.csv without errors.
void writeReportTables(const Trajectory& estimate, const std::string& directory);

/// Copies the file of `offline_odometry --stats` to pairs.csv, if its name is not empty; otherwise
/// removes that of an earlier report. Throws std::runtime_error if it cannot be copied.
void copyStatistics(const std::string& statistics, const std::string& directory);

}  // namespace rotrocc
