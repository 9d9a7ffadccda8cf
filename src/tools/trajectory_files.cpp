#include "tools/trajectory_files.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <vector>

#include <opencv2/core.hpp>

#include "common/to_seconds.h"
#include "evaluation/text_file.h"
#include "sequences/stereo_sequence.h"

namespace rotrocc {
namespace {

bool isTum(const std::string& path) {
  return detectTrajectoryFormat(path) == TrajectoryFormat::kTum;
}

bool hasStamps(const TrajectoryFiles& files) {
  return isTum(files.estimate) || !files.times.empty();
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
  const std::vector<TextLine> lines = readTextLines(statistics, ',');
  if (lines.front().words.front() != "stamp_ns") {
    lines.front().fail("there is no column stamp_ns: give a file of offline_odometry --stats");
  }
  std::vector<std::int64_t> stamps_ns;
  for (std::size_t i = 1; i < lines.size(); ++i) stamps_ns.push_back(lines[i].integer(0));
  return stamps_ns;
}

/// The poses of an estimate without stamps get those of the pairs in `source`.
Trajectory readWithStamps(const std::string& estimate,
                          const std::vector<std::int64_t>& stamps_ns,
                          const std::string& source,
                          const char* remedy) {
  Trajectory poses = readTrajectory(estimate);
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
                             "both must be from the same run, and poses in KITTI format need "
                             "--times");
  }
}

/// With the poses of a sequence, and its stamps if the estimate has none.
MatchedTrajectories readWithSequence(const TrajectoryFiles& files) {
  const StereoSequence sequence = openStereoSequence(files.truth, {});
  if (sequence.ground_truth.empty()) throw std::runtime_error(files.truth + " has no true poses");
  const Trajectory estimate = hasStamps(files) ? readTrajectory(files.estimate, files.times)
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
    std::cerr << "evaluate_trajectory: only the first poses of the longer file are used: "
              << files.truth << " has " << truth.size() << ", " << files.estimate << " has "
              << estimate.size() << '\n';
  }
  MatchedTrajectories matched = matchByIndex(truth, estimate);
  for (std::size_t i = 0; i < matched.truth.size(); ++i) {
    matched.truth[i].stamp_ns = matched.estimate[i].stamp_ns;
  }
  return matched;
}

/// As readEstimate(), before its stamps are compared with those of the statistics.
Trajectory readStamped(const TrajectoryFiles& files) {
  if (hasStamps(files) || files.statistics.empty()) {
    return readTrajectory(files.estimate, files.times);
  }
  return readWithStamps(files.estimate,
                        readStamps(files.statistics),
                        files.statistics,
                        "both must be from the same run");
}

MatchedTrajectories match(const TrajectoryFiles& files) {
  if (std::filesystem::is_directory(files.truth)) return readWithSequence(files);
  const bool truth_tum = isTum(files.truth);
  const bool estimate_tum = isTum(files.estimate);
  const bool finds_stamps = !files.times.empty() || (truth_tum && !files.statistics.empty());
  if (truth_tum != estimate_tum && !finds_stamps) {
    throw std::runtime_error((truth_tum ? files.estimate : files.truth) +
                             " has no stamps, but the other file has: give --times FILE");
  }
  if (truth_tum && estimate_tum && !files.times.empty()) {
    throw std::runtime_error("both files have stamps: leave out --times " + files.times);
  }
  const Trajectory truth = readTrajectory(files.truth, truth_tum ? "" : files.times);
  const Trajectory estimate = estimate_tum ? readTrajectory(files.estimate) : readStamped(files);
  return truth_tum || estimate_tum ? matchStamps(truth, estimate, files)
                                   : matchLines(truth, estimate, files);
}

}  // namespace

Trajectory readEstimate(const TrajectoryFiles& files) {
  Trajectory estimate = readStamped(files);
  requireStatisticsOf(estimate, files);
  return estimate;
}

MatchedTrajectories readMatched(const TrajectoryFiles& files) {
  MatchedTrajectories matched = match(files);
  requireStatisticsOf(matched.estimate, files);
  return matched;
}

}  // namespace rotrocc
