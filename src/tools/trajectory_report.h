#pragma once

#include <string>
#include <vector>

#include "rotrocc/trajectory_error.h"

namespace rotrocc {

constexpr double kDegreesPerRadian = 57.295779513082321;

struct Evaluation {
  MatchedTrajectories matched;
  std::vector<SegmentError> segments;
  std::vector<double> path_m = pathLengths(matched.truth);
  MeanError mean = meanError(segments);
  std::vector<MeanError> by_length = meanErrorByLength(segments);
  std::vector<MeanError> by_speed = meanErrorBySpeed(segments);
  std::vector<StepError> steps = stepErrors(matched);
  StepSummary step_summary = summarize(steps);
  Drift drift = finalDrift(matched);
};

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

}  // namespace rotrocc
