#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "input/to_text.h"
#include "rotrocc/trajectory_error.h"
#include "tools/draw_report.h"
#include "tools/program.h"
#include "tools/trajectory_files.h"
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
  TrajectoryFiles files;
  std::string segments_file;
  std::string report;
  std::string title;
  bool fit = false;
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

  po::options_description stamps("Stamps");
  stamps.add_options()(
      "times",
      po::value(&options.files.times),
      "times.txt with the stamps of poses in KITTI format (default: those of --stats, or 10 Hz)");

  po::options_description visible("Options");
  visible.add_options()("help,h", "show this help");
  visible.add(segments).add(output).add(stamps);
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

/// Lengths of segments that a short path has: about an eighth, a quarter and half of it.
std::string shortLengths(double path_m) {
  const double power = std::pow(10.0, std::floor(std::log10(path_m / 8.0)));
  const double shortest_m = power * std::floor(path_m / 8.0 / power);  // of one digit
  std::ostringstream lengths;
  lengths << shortest_m << ' ' << 2.0 * shortest_m << ' ' << 4.0 * shortest_m;
  return lengths.str();
}

void requireSegments(const std::vector<SegmentError>& errors,
                     const SegmentConfig& config,
                     double path_m) {
  if (!errors.empty()) return;
  std::ostringstream message;
  message << "no segment fits: the path is " << fixedText(path_m, 2)
          << " m long, the shortest segment "
          << *std::min_element(config.lengths_m.begin(), config.lengths_m.end()) << " m";
  if (path_m > 0.0) message << "; use --lengths " << shortLengths(path_m) << " --step 1";
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
  MatchedTrajectories matched = readMatched(options.files);
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
  if (options.files.truth.empty()) {
    writeReportTables(readEstimate(options.files), options.report);
  } else {
    const Evaluation evaluation = evaluateTruth(options);
    if (!options.segments_file.empty()) writeSegments(evaluation.segments, options.segments_file);
    if (!options.report.empty()) writeReportTables(evaluation, options.report);
    print(evaluation);
  }
  if (options.report.empty()) return;
  copyStatistics(options.files.statistics, options.report);
  drawReport(options.report, options.title);
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("evaluate_trajectory", argc, argv, parse, run);
}
