#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/core.hpp>

#include "bags/recorded_trajectory.h"
#include "common/to_seconds.h"
#include "files/report_directory.h"
#include "files/text_file.h"
#include "rotrocc/trajectory_error.h"
#include "sequences/stereo_sequence.h"
#include "tools/draw_report.h"
#include "tools/frame_alignment.h"
#include "tools/program.h"
#include "tools/trajectory_report.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const char* const kUsage =
    "Compares a trajectory with the ground truth by the metric of the KITTI odometry "
    "devkit, and writes a report.\n\n"
    "example: evaluate_trajectory dataset/poses/06.txt 06.txt --fit --report 06_report\n"
    "usage:   evaluate_trajectory GT EST [options]\n"
    "         evaluate_trajectory EST --report DIR [options]    without ground truth\n\n"
    "Both are in KITTI or TUM format, ASL's data.csv, BAG:TOPIC, or BAG:PARENT:CHILD of tf.\nTwo "
    "KITTI files are matched line by line, others by stamp, up to 10 ms apart.\n"
    "GT may also be the sequence of EST with its true poses: a directory in the layout of\nKITTI "
    "or ASL (EuRoC), or with files of "
    "camera_calibration. Poses of EST in KITTI format get the\nstamps of that sequence or of "
    "--stats, otherwise 10 Hz. Each row of the table by speed has the\nsegments within 2 m/s, so "
    "each segment counts twice.\n\n";

/// What evaluate_trajectory compares. Those that are not given are empty.
struct TrajectoryFiles {
  std::string truth;       ///< KITTI or TUM format, or a sequence with true poses
  std::string estimate;    ///< KITTI or TUM format
  std::string statistics;  ///< of offline_odometry from the same run as the estimate
};

struct Options {
  TrajectoryFiles files;
  std::string segments_file;
  std::string report;
  std::string title;
  bool fit = false;
  bool align_frames = false;
  SegmentConfig segments;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description segments("Segments");
  auto add = segments.add_options();
  add("fit", po::bool_switch(&options.fit), "choose lengths and step from the path length");
  add("lengths",
      po::value(&options.segments.lengths_m)->multitoken(),
      "lengths of the segments [m] (default: 100 200 300 400 500 600 700 800)");
  add("step", withDefault(options.segments.step), "segments start at every N-th pose");

  add("align-frames",
      po::bool_switch(&options.align_frames),
      "remove a constant rotation and lever arm between the bodies of GT and EST, e.g. base and "
      "camera");

  po::options_description output("Output");
  add = output.add_options();
  add("report",
      po::value(&options.report),
      "directory for an HTML report, its pictures (PNG) and its tables (CSV)");
  add("stats",
      po::value(&options.files.statistics),
      "statistics of offline_odometry --stats from the same run, for the report");
  add("title",
      po::value(&options.title),
      "title of the report (default: the name of the estimate)");
  add("segments",
      po::value(&options.segments_file),
      "CSV file with one row per segment: first pose, length, speed and errors");

  po::options_description visible("Options");
  visible.add_options()("help,h", "show this help");
  visible.add(segments).add(output);
  std::vector<std::string> files;
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage, visible, files, variables)) return false;
  if (files.empty() || files.size() > 2 || (files.size() == 1 && options.report.empty())) {
    throw po::error("expected two trajectories GT and EST, or EST and --report DIR");
  }
  if (options.fit && !(variables["lengths"].empty() && variables["step"].defaulted())) {
    throw po::error("--fit cannot be combined with --lengths or --step");
  }
  if (options.report.empty() && !options.files.statistics.empty()) {
    throw po::error("--stats is for the report: give --report DIR");
  }
  options.files.estimate = files.back();
  if (files.size() == 2) options.files.truth = files.front();
  if (options.title.empty()) options.title = std::filesystem::path(options.files.estimate).stem();
  return true;
}

bool isTum(const std::string& path) {
  return isInBag(path) || detectTrajectoryFormat(path) == TrajectoryFormat::kTum;
}

Trajectory readPoses(const std::string& path) {
  return isInBag(path) ? readRecordedTrajectory(path) : readTrajectory(path);
}

std::string timeRange(const std::string& path, const Trajectory& trajectory) {
  return path + cv::format(" covers %.2f to %.2f s",
                           toSeconds(trajectory.front().stamp_ns),
                           toSeconds(trajectory.back().stamp_ns));
}

MatchedTrajectories matchStamps(const Trajectory& truth,
                                const Trajectory& estimate,
                                const TrajectoryFiles& files) {
  MatchedTrajectories matched = matchByStamp(truth, estimate);
  if (matched.truth.size() < 2) {
    throw std::runtime_error(
        "fewer than two stamps match within 10 ms: " + timeRange(files.truth, truth) + ", " +
        timeRange(files.estimate, estimate));
  }
  return matched;
}

/// The stamps of the pairs in a file of statistics.
std::vector<std::int64_t> readStamps(const std::string& statistics) {
  const std::vector<TextLine> lines = readTextLines(statistics);
  if (lines.front().words.front() != "stamp_ns") {
    lines.front().fail("there is no column stamp_ns: give a file of offline_odometry --stats");
  }
  std::vector<std::int64_t> stamps_ns;
  for (std::size_t i = 1; i < lines.size(); ++i) stamps_ns.push_back(lines[i].nanoseconds(0, 1));
  return stamps_ns;
}

/// The poses of an estimate without stamps get those of the pairs in `source`.
Trajectory readWithStamps(const std::string& estimate,
                          const std::vector<std::int64_t>& stamps_ns,
                          const std::string& source,
                          const char* remedy) {
  Trajectory poses = readPoses(estimate);
  if (poses.size() != stamps_ns.size()) {
    throw std::runtime_error(estimate +
                             cv::format(" has %zu poses without stamps, but ", poses.size()) +
                             source + cv::format(" has %zu pairs: ", stamps_ns.size()) + remedy);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].stamp_ns = stamps_ns[i];
  return poses;
}

/// Each pose must have its pair.
void requireStatisticsOf(const Trajectory& estimate, const TrajectoryFiles& files) {
  if (files.statistics.empty()) return;
  std::vector<std::int64_t> stamps_ns = readStamps(files.statistics);
  std::sort(stamps_ns.begin(), stamps_ns.end());
  for (const StampedPose& pose : estimate) {
    if (std::binary_search(stamps_ns.begin(), stamps_ns.end(), pose.stamp_ns)) continue;
    throw std::runtime_error(files.statistics + " has no pair at " +
                             cv::format("%.6f s", toSeconds(pose.stamp_ns)) +
                             ", where there is a pose: the stamps of poses and statistics differ, "
                             "both must be from the same run");
  }
}

/// With the poses of a sequence, and its stamps if the estimate has none.
MatchedTrajectories readWithSequence(const TrajectoryFiles& files) {
  const StereoSequence sequence = openStereoSequence(files.truth, {});
  if (sequence.ground_truth.empty()) throw std::runtime_error(files.truth + " has no true poses");
  const Trajectory estimate = isTum(files.estimate) ? readPoses(files.estimate)
                                                    : readWithStamps(files.estimate,
                                                                     sequence.pairs.stamps_ns(),
                                                                     files.truth,
                                                                     "write it with --format tum");
  return matchStamps(sequence.ground_truth, estimate, files);
}

/// The stamps are those of the estimate.
MatchedTrajectories matchLines(const Trajectory& truth,
                               const Trajectory& estimate,
                               const TrajectoryFiles& files) {
  if (truth.size() != estimate.size()) {
    throw std::runtime_error(
        files.truth + cv::format(" has %zu poses, ", truth.size()) + files.estimate +
        cv::format(
            " %zu, and they have no stamps to match them by: write the estimate with --format "
            "tum, and give the directory of the sequence as GT",
            estimate.size()));
  }
  MatchedTrajectories matched = matchByIndex(truth, estimate);
  for (std::size_t i = 0; i < matched.truth.size(); ++i) {
    matched.truth[i].stamp_ns = matched.estimate[i].stamp_ns;
  }
  return matched;
}

Trajectory readStamped(const TrajectoryFiles& files) {
  if (isTum(files.estimate) || files.statistics.empty()) return readPoses(files.estimate);
  return readWithStamps(files.estimate,
                        readStamps(files.statistics),
                        files.statistics,
                        "both must be from the same run");
}

MatchedTrajectories match(const TrajectoryFiles& files) {
  if (std::filesystem::is_directory(files.truth)) return readWithSequence(files);
  const bool truth_tum = isTum(files.truth);
  const bool estimate_tum = isTum(files.estimate);
  if (truth_tum != estimate_tum && (estimate_tum || files.statistics.empty())) {
    throw std::runtime_error((truth_tum ? files.estimate : files.truth) +
                             " has no stamps, but the other file has: give the directory of the "
                             "sequence as GT");
  }
  const Trajectory truth = readPoses(files.truth);
  const Trajectory estimate = readStamped(files);
  return truth_tum ? matchStamps(truth, estimate, files) : matchLines(truth, estimate, files);
}

void requireSegments(const std::vector<SegmentError>& errors,
                     const SegmentConfig& config,
                     double path_m) {
  if (!errors.empty()) return;
  const double shortest_m = *std::min_element(config.lengths_m.begin(), config.lengths_m.end());
  throw std::runtime_error(
      cv::format("no segment fits: the path is %.2f m long, the shortest segment %g m",
                 path_m,
                 shortest_m) +
      (path_m > 0.0 ? cv::format("; use --lengths %.2g %.2g --step 1", 0.25 * path_m, 0.5 * path_m)
                    : ""));
}

void printTable(const char* bin_name, const std::vector<MeanError>& means) {
  std::printf(
      "\n%12s  %8s  %14s  %18s\n", bin_name, "segments", "translation [%]", "rotation [deg/m]");
  for (const MeanError& mean : means) {
    std::printf("%12g  %8d  %15.3f  %16.5f\n",
                mean.bin,
                mean.segments,
                100.0 * mean.translation,
                kDegreesPerRadian * mean.rotation_rad_per_m);
  }
}

void printDistribution(const char* name, const Distribution& values, double scale) {
  std::printf("%-18s  %9.4f  %9.4f  %9.4f  %9.4f\n",
              name,
              scale * values.mean,
              scale * values.rms,
              scale * values.p95,
              scale * values.max);
}

/// Takes out what differs between the bodies of both if that is wanted, or else says it.
void alignFrames(const Options& options, MatchedTrajectories& matched) {
  const FrameAlignment alignment = rotrocc::alignFrames(matched);
  if (options.align_frames) {
    matched.estimate = withFrame(matched.estimate, alignment);
    std::cerr << "evaluate_trajectory: the body of GT is " << alignment.describe()
              << " in the frame of EST, which is removed\n";
  } else if (alignment.isNeeded()) {
    std::cerr << "evaluate_trajectory: EST is of another body than GT, which is "
              << alignment.describe()
              << cv::format(
                     " in its frame: motions differ by %.1f %% of their way, and by %.1f %% "
                     "with --align-frames\n",
                     100.0 * alignment.error_before,
                     100.0 * alignment.error_after);
  }
}

/// Evaluates the matched poses; throws if no segment fits and no report is requested.
Evaluation evaluateTruth(const Options& options) {
  MatchedTrajectories matched = match(options.files);
  requireStatisticsOf(matched.estimate, options.files);
  alignFrames(options, matched);
  const double path_m = pathLengths(matched.truth).back();
  const SegmentConfig segments = options.fit ? fittingSegments(path_m) : options.segments;
  const Evaluation evaluation = {matched, segmentErrors(matched, segments)};
  if (options.report.empty()) requireSegments(evaluation.segments, segments, path_m);
  return evaluation;
}

void print(const Evaluation& evaluation) {
  const double path_m = evaluation.path_m.back();
  std::printf("translation %.3f %%, rotation %.5f deg/m (%d segments, %zu poses, %.1f m)\n",
              100.0 * evaluation.mean.translation,
              kDegreesPerRadian * evaluation.mean.rotation_rad_per_m,
              evaluation.mean.segments,
              evaluation.path_m.size(),
              path_m);
  printTable("length [m]", evaluation.by_length);
  printTable("speed [m/s]", evaluation.by_speed);

  const StepSummary& steps = evaluation.step_summary;
  std::printf("\n%-18s  %9s  %9s  %9s  %9s\n", "pose to pose", "mean", "rms", "p95", "max");
  printDistribution("translation [m]", steps.translation_m, 1.0);
  printDistribution("rotation [deg]", steps.rotation_rad, kDegreesPerRadian);

  std::printf("\nfinal drift: %.3f m (%.3f %% of the path), %.3f deg\n",
              evaluation.drift.translation_m,
              100.0 * evaluation.drift.translation_m / path_m,
              kDegreesPerRadian * evaluation.drift.rotation_rad);
}

void run(const Options& options) {
  if (!options.report.empty()) ReportDirectory::require(options.report);
  if (options.files.truth.empty()) {
    const Trajectory estimate = readStamped(options.files);
    requireStatisticsOf(estimate, options.files);
    writeReportTables(estimate, options.report);
  } else {
    const Evaluation evaluation = evaluateTruth(options);
    if (!options.segments_file.empty()) writeSegments(evaluation.segments, options.segments_file);
    if (!options.report.empty()) writeReportTables(evaluation, options.report);
    print(evaluation);
  }
  if (options.report.empty()) return;
  namespace fs = std::filesystem;
  const std::string& statistics = options.files.statistics;
  const std::string pairs = options.report + "/pairs.csv";
  std::error_code error;
  if (statistics.empty()) {
    fs::remove(pairs, error);  // of an earlier report
  } else if (!fs::equivalent(statistics, pairs, error)) {
    fs::copy_file(statistics, pairs, fs::copy_options::overwrite_existing, error);
    if (error) throw std::runtime_error("cannot copy " + statistics + ": " + error.message());
  }
  drawReport(options.report, options.title);
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("evaluate_trajectory", argc, argv, parse, run);
}
