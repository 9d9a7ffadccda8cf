#include "rotrocc/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>

#include "common/to_seconds.h"
#include "evaluation/trajectory_sampling.h"

namespace rotrocc {
namespace {

constexpr double kSpeedBin_mps = 2.0;

Eigen::Isometry3d motionError(const MatchedTrajectories& matched,
                              std::size_t from,
                              std::size_t to) {
  const auto motion = [=](const Trajectory& poses) -> Eigen::Isometry3d {
    return poses[from].T_world_body.inverse() * poses[to].T_world_body;
  };
  return motion(matched.estimate).inverse() * motion(matched.truth);
}

double rotationAngle(const Eigen::Isometry3d& pose) {
  return Eigen::AngleAxisd(pose.linear()).angle();
}

std::size_t nearest(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const auto later = std::lower_bound(
      trajectory.begin(), trajectory.end(), stamp_ns, [](const StampedPose& pose, std::int64_t ns) {
        return pose.stamp_ns < ns;
      });
  const auto index = static_cast<std::size_t>(later - trajectory.begin());
  if (index == 0) return 0;
  if (later == trajectory.end()) return index - 1;
  return later->stamp_ns - stamp_ns < stamp_ns - trajectory[index - 1].stamp_ns ? index : index - 1;
}

/// The pose at `stamp_ns` if the truth has at least 50 Hz, otherwise that of its nearest pose: what
/// moves by 1 m/s is 5 mm apart after half a period of 100 Hz.
StampedPose truthAt(const Trajectory& truth, std::int64_t stamp_ns, const StampedPose& nearest) {
  constexpr std::int64_t kMaxGap_ns = 20'000'000;
  const auto pose = poseAt(truth, stamp_ns, kMaxGap_ns);
  return pose ? StampedPose{stamp_ns, *pose} : nearest;
}

void requireMatched(const MatchedTrajectories& matched) {
  if (matched.truth.size() == matched.estimate.size()) return;
  throw std::invalid_argument("trajectories are not matched: the truth has " +
                              std::to_string(matched.truth.size()) + " poses, the estimate " +
                              std::to_string(matched.estimate.size()));
}

double duration_s(const StampedPose& first, const StampedPose& last) {
  const std::int64_t duration_ns = last.stamp_ns - first.stamp_ns;
  if (duration_ns > 0) return toSeconds(duration_ns);
  throw std::invalid_argument(
      "stamps of the truth do not increase: " + std::to_string(last.stamp_ns) + " ns comes after " +
      std::to_string(first.stamp_ns) + " ns");
}

void check(const SegmentConfig& config) {
  for (const double length_m : config.lengths_m) {
    if (!(std::isfinite(length_m) && length_m > 0.0)) {
      throw std::invalid_argument("segment length " + std::to_string(length_m) +
                                  " m must be positive");
    }
  }
  if (config.step < 1) {
    throw std::invalid_argument("segment step " + std::to_string(config.step) +
                                " must be at least 1");
  }
}

template <typename Predicate>
MeanError meanWhere(const std::vector<SegmentError>& errors, double bin, Predicate belongs) {
  MeanError mean;
  mean.bin = bin;
  for (const SegmentError& error : errors) {
    if (!belongs(error)) continue;
    ++mean.segments;
    mean.translation += error.translation;
    mean.rotation_rad_per_m += error.rotation_rad_per_m;
  }
  if (mean.segments == 0) return mean;
  mean.translation /= mean.segments;
  mean.rotation_rad_per_m /= mean.segments;
  return mean;
}

Distribution distributionOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  Distribution distribution;
  distribution.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  distribution.rms =
      std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / count);
  distribution.p95 = values[(values.size() * 95 + 99) / 100 - 1];
  distribution.max = values.back();
  return distribution;
}

}  // namespace

MatchedTrajectories matchByIndex(const Trajectory& truth, const Trajectory& estimate) {
  const auto count = static_cast<std::ptrdiff_t>(std::min(truth.size(), estimate.size()));
  return {Trajectory(truth.begin(), truth.begin() + count),
          Trajectory(estimate.begin(), estimate.begin() + count)};
}

MatchedTrajectories matchByStamp(const Trajectory& truth,
                                 const Trajectory& estimate,
                                 double max_difference_s) {
  MatchedTrajectories matched;
  if (truth.empty()) return matched;
  const auto max_difference_ns = std::llround(max_difference_s * 1e9);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const StampedPose& partner = truth[nearest(truth, estimate[i].stamp_ns)];
    if (std::llabs(partner.stamp_ns - estimate[i].stamp_ns) > max_difference_ns) continue;
    if (nearest(estimate, partner.stamp_ns) != i) continue;
    matched.truth.push_back(truthAt(truth, estimate[i].stamp_ns, partner));
    matched.estimate.push_back(estimate[i]);
  }
  return matched;
}

std::vector<double> pathLengths(const Trajectory& truth) {
  std::vector<double> lengths_m(truth.size(), 0.0);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Eigen::Vector3d step =
        truth[i].T_world_body.translation() - truth[i - 1].T_world_body.translation();
    lengths_m[i] = lengths_m[i - 1] + step.norm();
  }
  return lengths_m;
}

SegmentConfig fittingSegments(double path_m) {
  const SegmentConfig devkit;
  if (path_m >= 2.0 * devkit.lengths_m.front()) return devkit;
  return {{5, 10, 20, 30, 40}, 1};
}

std::vector<SegmentError> segmentErrors(const MatchedTrajectories& matched,
                                        const SegmentConfig& config) {
  requireMatched(matched);
  check(config);
  const std::vector<double> path_m = pathLengths(matched.truth);
  std::vector<SegmentError> errors;
  for (std::size_t first = 0; first < path_m.size(); first += config.step) {
    for (const double length_m : config.lengths_m) {
      const auto end = std::upper_bound(path_m.begin(), path_m.end(), path_m[first] + length_m);
      if (end == path_m.end()) continue;
      const auto last = static_cast<std::size_t>(end - path_m.begin());
      const Eigen::Isometry3d error = motionError(matched, first, last);
      errors.push_back({static_cast<int>(first),
                        length_m,
                        length_m / duration_s(matched.truth[first], matched.truth[last]),
                        error.translation().norm() / length_m,
                        rotationAngle(error) / length_m});
    }
  }
  return errors;
}

MeanError meanError(const std::vector<SegmentError>& errors) {
  return meanWhere(errors, 0.0, [](const SegmentError&) { return true; });
}

std::vector<MeanError> meanErrorByLength(const std::vector<SegmentError>& errors) {
  std::set<double> lengths_m;
  for (const SegmentError& error : errors) lengths_m.insert(error.length_m);
  std::vector<MeanError> means;
  for (const double length_m : lengths_m) {
    means.push_back(meanWhere(
        errors, length_m, [=](const SegmentError& error) { return error.length_m == length_m; }));
  }
  return means;
}

std::vector<MeanError> meanErrorBySpeed(const std::vector<SegmentError>& errors) {
  std::set<double> speeds_mps;
  for (const SegmentError& error : errors) {
    const double below_mps = std::floor(error.speed_mps / kSpeedBin_mps) * kSpeedBin_mps;
    if (below_mps > 0.0) speeds_mps.insert(below_mps);
    if (below_mps < error.speed_mps) speeds_mps.insert(below_mps + kSpeedBin_mps);
  }
  std::vector<MeanError> means;
  for (const double speed_mps : speeds_mps) {
    means.push_back(meanWhere(errors, speed_mps, [=](const SegmentError& error) {
      return std::abs(error.speed_mps - speed_mps) < kSpeedBin_mps;
    }));
  }
  return means;
}

std::vector<StepError> stepErrors(const MatchedTrajectories& matched) {
  requireMatched(matched);
  std::vector<StepError> steps;
  for (std::size_t i = 1; i < matched.truth.size(); ++i) {
    const Eigen::Isometry3d error = motionError(matched, i - 1, i);
    steps.push_back({error.translation().norm(), rotationAngle(error)});
  }
  return steps;
}

StepSummary summarize(const std::vector<StepError>& steps) {
  std::vector<double> translations_m;
  std::vector<double> rotations_rad;
  for (const StepError& step : steps) {
    translations_m.push_back(step.translation_m);
    rotations_rad.push_back(step.rotation_rad);
  }
  return {distributionOf(std::move(translations_m)), distributionOf(std::move(rotations_rad))};
}

Drift finalDrift(const MatchedTrajectories& matched) {
  requireMatched(matched);
  if (matched.truth.empty()) return {};
  const Eigen::Isometry3d error = motionError(matched, 0, matched.truth.size() - 1);
  return {error.translation().norm(), rotationAngle(error)};
}

}  // namespace rotrocc
