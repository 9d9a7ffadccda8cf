#pragma once

#include <string>
#include <vector>

#include "rotrocc/trajectory_error.h"

namespace rotrocc {

constexpr double kDegreesPerRadian = 57.295779513082321;

/// All that is to be said of an estimate.
struct Evaluation {
  MatchedTrajectories matched;
  std::vector<double> path_m;  ///< of the truth, to each pose
  std::vector<SegmentError> segments;
  MeanError mean;
  std::vector<MeanError> by_length;
  std::vector<MeanError> by_speed;
  std::vector<StepError> steps;
  Drift drift;
};

/// Throws std::invalid_argument like segmentErrors().
Evaluation evaluate(MatchedTrajectories matched, const SegmentConfig& segments);

/// A CSV table with a row for each segment. Throws std::runtime_error if it cannot be written.
void writeSegments(const std::vector<SegmentError>& segments, const std::string& path);

/// Writes the tables of a report into a directory, which is made if it is not there, and replaces
/// those of an earlier one:
///   summary.csv     one row: poses, path, mean errors, errors of steps, drift
///   poses.csv       stamp, path, true and estimated position, each in the frame of its first pose,
///                   and the error of the step that led there (nan for the first)
///   segments.csv, by_length.csv, by_speed.csv    the metric of the KITTI devkit
/// Throws std::runtime_error if they cannot be written.
void writeReportTables(const Evaluation& evaluation, const std::string& directory);

/// The same where there is no truth: summary.csv and poses.csv without errors.
void writeReportTables(const Trajectory& estimate, const std::string& directory);

/// Copies the file of `offline_odometry --stats` to pairs.csv, if its name is not empty, and
/// becomes the program draw_report beside this one, which draws what the tables say and writes the
/// page. Returns only by std::runtime_error.
[[noreturn]] void drawReport(const std::string& directory,
                             const std::string& statistics,
                             const std::string& title);

}  // namespace rotrocc
