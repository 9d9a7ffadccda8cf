#include "tools/trajectory_report.h"

#include <limits>

#include "common/to_seconds.h"
#include "files/csv_file.h"
#include "files/report_directory.h"

namespace rotrocc {
namespace {

/// Positions [m] in the frame of the first pose.
std::vector<Eigen::Vector3d> positions(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> positions;
  for (const StampedPose& pose : trajectory) {
    positions.push_back(trajectory.front().T_world_body.inverse() *
                        pose.T_world_body.translation());
  }
  return positions;
}

double duration_s(const Trajectory& trajectory) {
  return toSeconds(trajectory.back().stamp_ns - trajectory.front().stamp_ns);
}

void writeMeans(const std::vector<MeanError>& means, const char* bin, const std::string& path) {
  CsvFile table(path, std::string(bin) + ",segments,translation_percent,rotation_deg_per_m");
  for (const MeanError& mean : means) {
    table.row({mean.bin,
               static_cast<double>(mean.segments),
               100.0 * mean.translation,
               kDegreesPerRadian * mean.rotation_rad_per_m});
  }
}

void writeSummary(const Evaluation& evaluation, const std::string& path) {
  const StepSummary& steps = evaluation.step_summary;
  const double path_m = evaluation.path_m.back();
  CsvFile table(path,
                "poses,path_m,duration_s,segments,translation_percent,rotation_deg_per_m,"
                "step_translation_mean_m,step_translation_rms_m,step_translation_p95_m,"
                "step_translation_max_m,step_rotation_mean_deg,step_rotation_rms_deg,"
                "step_rotation_p95_deg,step_rotation_max_deg,drift_m,drift_percent,drift_deg");
  table.row({static_cast<double>(evaluation.path_m.size()),
             path_m,
             duration_s(evaluation.matched.truth),
             static_cast<double>(evaluation.mean.segments),
             100.0 * evaluation.mean.translation,
             kDegreesPerRadian * evaluation.mean.rotation_rad_per_m,
             steps.translation_m.mean,
             steps.translation_m.rms,
             steps.translation_m.p95,
             steps.translation_m.max,
             kDegreesPerRadian * steps.rotation_rad.mean,
             kDegreesPerRadian * steps.rotation_rad.rms,
             kDegreesPerRadian * steps.rotation_rad.p95,
             kDegreesPerRadian * steps.rotation_rad.max,
             evaluation.drift.translation_m,
             100.0 * evaluation.drift.translation_m / path_m,
             kDegreesPerRadian * evaluation.drift.rotation_rad});
}

void writePoses(const Evaluation& evaluation, const std::string& path) {
  const std::vector<Eigen::Vector3d> truth = positions(evaluation.matched.truth);
  const std::vector<Eigen::Vector3d> estimate = positions(evaluation.matched.estimate);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  CsvFile table(path,
                "stamp_ns,path_m,true_x_m,true_y_m,true_z_m,x_m,y_m,z_m,step_translation_error_m,"
                "step_rotation_error_deg");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const StepError step = i > 0 ? evaluation.steps[i - 1] : StepError{kNone, kNone};
    table << evaluation.matched.estimate[i].stamp_ns;
    table.row({evaluation.path_m[i],
               truth[i].x(),
               truth[i].y(),
               truth[i].z(),
               estimate[i].x(),
               estimate[i].y(),
               estimate[i].z(),
               step.translation_m,
               kDegreesPerRadian * step.rotation_rad});
  }
}

}  // namespace

void writeSegments(const std::vector<SegmentError>& segments, const std::string& path) {
  CsvFile table(path, "first_pose,length_m,speed_mps,translation_percent,rotation_deg_per_m");
  for (const SegmentError& segment : segments) {
    table.row({static_cast<double>(segment.first_pose),
               segment.length_m,
               segment.speed_mps,
               100.0 * segment.translation,
               kDegreesPerRadian * segment.rotation_rad_per_m});
  }
}

void writeReportTables(const Evaluation& evaluation, const std::string& directory) {
  ReportDirectory files(directory);
  writeSummary(evaluation, files.path("summary.csv"));
  writePoses(evaluation, files.path("poses.csv"));
  writeSegments(evaluation.segments, files.path("segments.csv"));
  writeMeans(evaluation.by_length, "length_m", files.path("by_length.csv"));
  writeMeans(evaluation.by_speed, "speed_mps", files.path("by_speed.csv"));
}

void writeReportTables(const Trajectory& estimate, const std::string& directory) {
  ReportDirectory files(directory);
  const std::vector<double> path_m = pathLengths(estimate);
  CsvFile summary(files.path("summary.csv"), "poses,path_m,duration_s");
  summary.row({static_cast<double>(estimate.size()), path_m.back(), duration_s(estimate)});

  const std::vector<Eigen::Vector3d> points = positions(estimate);
  CsvFile poses(files.path("poses.csv"), "stamp_ns,path_m,x_m,y_m,z_m");
  for (std::size_t i = 0; i < points.size(); ++i) {
    poses << estimate[i].stamp_ns;
    poses.row({path_m[i], points[i].x(), points[i].y(), points[i].z()});
  }
}

}  // namespace rotrocc
