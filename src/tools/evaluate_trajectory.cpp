#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <boost/program_options.hpp>

#include "common/to_seconds.h"
#include "rotrocc/trajectory.h"
#include "rotrocc/trajectory_error.h"
#include "sequences/stereo_sequence.h"
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
    "Both are in KITTI or TUM format; two KITTI files are matched line by line, others by "
    "stamp, up to 10 ms\napart. GT may also be the sequence that EST is of, with its true "
    "poses: a directory in the layout of\nKITTI or ASL (EuRoC), or with files of "
    "camera_calibration. Each row of the table by speed has the\nsegments up to 2 m/s "
    "slower or faster, so each segment counts twice.\n\n";

struct Options {
  std::string truth;
  std::string estimate;
  std::string times;
  std::string segments_file;
  std::string report;
  std::string statistics;
  std::string title;
  bool fit = false;
  SegmentConfig segments;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("lengths",
      po::value(&options.segments.lengths_m)->multitoken(),
      "lengths of the segments [m] (default: 100 200 300 400 500 600 700 800)");
  add("step",
      po::value(&options.segments.step)->default_value(options.segments.step),
      "segments start at every N-th pose");
  add("fit", po::bool_switch(&options.fit), "choose both from the path length");
  add("times",
      po::value(&options.times),
      "times.txt with the stamps of poses in KITTI format (default: those of --stats, or 10 Hz)");
  add("segments",
      po::value(&options.segments_file),
      "CSV output file with one row per segment: first pose, length, speed and errors");
  add("report",
      po::value(&options.report),
      "output directory for an HTML report, its pictures (PNG) and its tables (CSV)");
  add("stats",
      po::value(&options.statistics),
      "statistics of offline_odometry --stats from the same run, for the report");
  add("title",
      po::value(&options.title),
      "title of the report (default: the name of the estimate)");
  std::vector<std::string> files;
  PositionalArguments trajectories;
  trajectories.options.add_options()("files", po::value(&files));
  trajectories.order.add("files", -1);
  po::variables_map variables;
  if (!parseCommandLine(argc, argv, kUsage, visible, trajectories, variables)) return false;
  if (files.empty() || files.size() > 2 || (files.size() == 1 && options.report.empty())) {
    throw po::error("expected two trajectories GT and EST, or EST and --report DIR");
  }
  if (options.fit && !(variables["lengths"].empty() && variables["step"].defaulted())) {
    throw po::error("--fit cannot be combined with --lengths or --step");
  }
  if (options.report.empty() && !options.statistics.empty()) {
    throw po::error("--stats is for the report: give --report DIR");
  }
  options.estimate = files.back();
  if (files.size() == 2) options.truth = files.front();
  if (options.title.empty()) options.title = std::filesystem::path(options.estimate).stem();
  return true;
}

bool isTum(const std::string& path) {
  return detectTrajectoryFormat(path) == TrajectoryFormat::kTum;
}

std::string timeRange(const std::string& path, const Trajectory& trajectory) {
  std::ostringstream range;
  range << std::fixed << std::setprecision(2) << path << " covers "
        << toSeconds(trajectory.front().stamp_ns) << " to " << toSeconds(trajectory.back().stamp_ns)
        << " s";
  return range.str();
}

MatchedTrajectories matchStamps(const Trajectory& truth,
                                const Trajectory& estimate,
                                const Options& options) {
  MatchedTrajectories matched = matchByStamp(truth, estimate);
  if (matched.truth.size() < 2) {
    throw std::runtime_error(
        "fewer than two stamps match within 10 ms: " + timeRange(options.truth, truth) + ", " +
        timeRange(options.estimate, estimate));
  }
  return matched;
}

/// The stamps of statistics, which are in the first column.
std::vector<std::int64_t> stampsOf(const std::string& statistics) {
  std::ifstream file(statistics);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error(statistics + " cannot be read");
  std::vector<std::int64_t> stamps_ns;
  while (std::getline(file, line)) {
    std::int64_t stamp_ns = 0;
    if (std::from_chars(line.data(), line.data() + line.size(), stamp_ns).ec != std::errc()) {
      throw std::runtime_error(statistics + ": no stamp in \"" + line + "\"");
    }
    stamps_ns.push_back(stamp_ns);
  }
  return stamps_ns;
}

/// Poses without stamps get those of --times, or else those of --stats, if they are given.
Trajectory readEstimate(const Options& options) {
  Trajectory estimate = readTrajectory(options.estimate, options.times);
  const bool has_stamps = isTum(options.estimate) || !options.times.empty();
  if (has_stamps || options.statistics.empty()) return estimate;
  const std::vector<std::int64_t> stamps_ns = stampsOf(options.statistics);
  if (stamps_ns.size() != estimate.size()) {
    throw std::runtime_error(options.estimate + " has " + std::to_string(estimate.size()) +
                             " poses, but " + options.statistics + " has " +
                             std::to_string(stamps_ns.size()) +
                             " pairs: both must be from the same run");
  }
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) estimate[i].stamp_ns = stamps_ns[i];
  return estimate;
}

/// With the poses of a sequence, and its stamps if the estimate has none.
MatchedTrajectories loadWithSequence(const Options& options) {
  const auto sequence = openStereoSequence(options.truth, {});
  if (sequence->groundTruth().empty()) {
    throw std::runtime_error(options.truth + " has no true poses");
  }
  Trajectory estimate = readTrajectory(options.estimate, options.times);
  if (!isTum(options.estimate) && options.times.empty()) {
    if (static_cast<int>(estimate.size()) != sequence->size()) {
      throw std::runtime_error(options.estimate + " has " + std::to_string(estimate.size()) +
                               " poses without stamps, but " + options.truth + " has " +
                               std::to_string(sequence->size()) +
                               " pairs: write it with --format tum");
    }
    for (int i = 0; i < sequence->size(); ++i) estimate[i].stamp_ns = sequence->stamp_ns(i);
  }
  return matchStamps(sequence->groundTruth(), estimate, options);
}

MatchedTrajectories load(const Options& options) {
  if (std::filesystem::is_directory(options.truth)) return loadWithSequence(options);
  const bool truth_tum = isTum(options.truth);
  const bool estimate_tum = isTum(options.estimate);
  const bool has_times =
      !options.times.empty() || (truth_tum && !options.statistics.empty());  // of the estimate
  if (truth_tum != estimate_tum && !has_times) {
    throw std::runtime_error((truth_tum ? options.estimate : options.truth) +
                             " has no stamps, but the other file has: give --times FILE");
  }
  if (truth_tum && estimate_tum && !options.times.empty()) {
    throw std::runtime_error("both files have stamps: leave out --times " + options.times);
  }
  const Trajectory truth = readTrajectory(options.truth, truth_tum ? "" : options.times);
  Options of_estimate = options;
  if (estimate_tum) of_estimate.times.clear();  // they are those of the truth
  const Trajectory estimate = readEstimate(of_estimate);
  if (!truth_tum && !estimate_tum) {
    if (truth.size() != estimate.size()) {
      std::cerr << "evaluate_trajectory: only the first poses of the longer file are used: "
                << options.truth << " has " << truth.size() << ", " << options.estimate << " has "
                << estimate.size() << '\n';
    }
    MatchedTrajectories matched = matchByIndex(truth, estimate);
    for (std::size_t i = 0; i < matched.truth.size(); ++i) {
      matched.truth[i].stamp_ns = matched.estimate[i].stamp_ns;
    }
    return matched;
  }
  return matchStamps(truth, estimate, options);
}

void requireSegments(const std::vector<SegmentError>& errors,
                     const SegmentConfig& config,
                     double path_m) {
  if (!errors.empty()) return;
  std::ostringstream message;
  message.precision(3);
  message << "no segment fits: the path is " << path_m << " m long, the shortest segment "
          << *std::min_element(config.lengths_m.begin(), config.lengths_m.end())
          << " m; use shorter segments, e.g. --lengths 5 10 20 30 40 --step 1, or --fit";
  throw std::runtime_error(message.str());
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

/// Evaluates the matched poses; throws if no segment fits and no report is requested.
Evaluation evaluateTruth(const Options& options) {
  MatchedTrajectories matched = load(options);
  const double path_m = pathLengths(matched.truth).back();
  const SegmentConfig segments = options.fit ? fittingSegments(path_m) : options.segments;
  Evaluation evaluation = evaluate(std::move(matched), segments);
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

  const StepSummary steps = summarize(evaluation.steps);
  std::printf("\n%-18s  %9s  %9s  %9s  %9s\n", "pose to pose", "mean", "rms", "p95", "max");
  printDistribution("translation [m]", steps.translation_m, 1.0);
  printDistribution("rotation [deg]", steps.rotation_rad, kDegreesPerRadian);

  std::printf("\nfinal drift: %.3f m (%.3f %% of the path), %.3f deg\n",
              evaluation.drift.translation_m,
              100.0 * evaluation.drift.translation_m / path_m,
              kDegreesPerRadian * evaluation.drift.rotation_rad);
}

void run(const Options& options) {
  if (options.truth.empty()) {
    writeReportTables(readEstimate(options), options.report);
  } else {
    const Evaluation evaluation = evaluateTruth(options);
    if (!options.segments_file.empty()) writeSegments(evaluation.segments, options.segments_file);
    if (!options.report.empty()) writeReportTables(evaluation, options.report);
    print(evaluation);
  }
  if (!options.report.empty()) drawReport(options.report, options.statistics, options.title);
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("evaluate_trajectory", argc, argv, parse, run);
}
