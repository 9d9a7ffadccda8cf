#include "rotrocc/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>

#include <opencv2/core.hpp>

#include "common/median.h"
#include "common/to_seconds.h"

namespace rotrocc {
namespace {

StepError motionError(const MatchedTrajectories& matched, std::size_t from, std::size_t to) {
  const auto motion = [=](const Trajectory& poses) -> Eigen::Isometry3d {
    return poses[from].T_world_body.inverse() * poses[to].T_world_body;
  };
  const Eigen::Isometry3d error = motion(matched.estimate).inverse() * motion(matched.truth);
  return {error.translation().norm(), Eigen::AngleAxisd(error.linear()).angle()};
}

std::size_t nearest(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const auto later = firstFrom(trajectory, stamp_ns);
  const auto index = static_cast<std::size_t>(later - trajectory.begin());
  if (index == 0) return 0;
  if (later == trajectory.end()) return index - 1;
  return later->stamp_ns - stamp_ns < stamp_ns - trajectory[index - 1].stamp_ns ? index : index - 1;
}

void requireMatched(const MatchedTrajectories& matched) {
  if (matched.truth.size() == matched.estimate.size()) return;
  throw std::invalid_argument(
      cv::format("trajectories are not matched: the truth has %zu poses, the estimate %zu",
                 matched.truth.size(),
                 matched.estimate.size()));
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
    if (std::isfinite(length_m) && length_m > 0.0) continue;
    throw std::invalid_argument(cv::format("segment length %g m must be positive", length_m));
  }
  if (config.step >= 1) return;
  throw std::invalid_argument(cv::format("segment step %d must be at least 1", config.step));
}

/// The mean of the errors in each bin; an error belongs to it if in_bin(error, bin).
template <class InBin>
std::vector<MeanError> meansOf(const std::vector<SegmentError>& errors,
                               const std::set<double>& bins,
                               InBin in_bin) {
  std::vector<MeanError> means;
  for (const double bin : bins) {
    MeanError& mean = means.emplace_back();
    mean.bin = bin;
    for (const SegmentError& error : errors) {
      if (!in_bin(error, bin)) continue;
      ++mean.segments;
      mean.translation += error.translation;
      mean.rotation_rad_per_m += error.rotation_rad_per_m;
    }
    if (mean.segments == 0) continue;
    mean.translation /= mean.segments;
    mean.rotation_rad_per_m /= mean.segments;
  }
  return means;
}

/// Of one part of the errors.
Distribution distributionOf(const std::vector<StepError>& steps, double StepError::*part) {
  if (steps.empty()) return {};
  std::vector<double> values;
  for (const StepError& step : steps) values.push_back(step.*part);
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), static_cast<long>(values.size()));
  return {all.mean(), std::sqrt(all.square().mean()), quantile(values, 0.95), all.maxCoeff()};
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
  // Between the poses of a truth of at least 50 Hz, otherwise its nearest pose: what moves by 1 m/s
  // is 5 mm apart after half a period of 100 Hz.
  constexpr std::int64_t kMaxGap_ns = 20'000'000;
  MatchedTrajectories matched;
  if (truth.empty()) return matched;
  const auto max_difference_ns = std::llround(max_difference_s * 1e9);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const std::int64_t stamp_ns = estimate[i].stamp_ns;
    const StampedPose& partner = truth[nearest(truth, stamp_ns)];
    if (std::llabs(partner.stamp_ns - stamp_ns) > max_difference_ns) continue;
    if (nearest(estimate, partner.stamp_ns) != i) continue;
    const auto pose = poseAt(truth, stamp_ns, kMaxGap_ns);
    matched.truth.push_back(pose ? StampedPose{stamp_ns, *pose} : partner);
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
      const StepError error = motionError(matched, first, last);
      errors.push_back({static_cast<int>(first),
                        length_m,
                        length_m / duration_s(matched.truth[first], matched.truth[last]),
                        error.translation_m / length_m,
                        error.rotation_rad / length_m});
    }
  }
  return errors;
}

MeanError meanError(const std::vector<SegmentError>& errors) {
  return meansOf(errors, {0.0}, [](const SegmentError&, double) { return true; }).front();
}

std::vector<MeanError> meanErrorByLength(const std::vector<SegmentError>& errors) {
  std::set<double> lengths_m;
  for (const SegmentError& error : errors) lengths_m.insert(error.length_m);
  return meansOf(errors, lengths_m, [](const SegmentError& error, double length_m) {
    return error.length_m == length_m;
  });
}

std::vector<MeanError> meanErrorBySpeed(const std::vector<SegmentError>& errors) {
  constexpr double kBin_mps = 2.0;
  std::set<double> speeds_mps;
  for (const SegmentError& error : errors) {
    const double below_mps = std::floor(error.speed_mps / kBin_mps) * kBin_mps;
    if (below_mps > 0.0) speeds_mps.insert(below_mps);
    if (below_mps < error.speed_mps) speeds_mps.insert(below_mps + kBin_mps);
  }
  return meansOf(errors, speeds_mps, [](const SegmentError& error, double speed_mps) {
    return std::abs(error.speed_mps - speed_mps) < kBin_mps;
  });
}

std::vector<StepError> stepErrors(const MatchedTrajectories& matched) {
  requireMatched(matched);
  std::vector<StepError> steps;
  for (std::size_t i = 1; i < matched.truth.size(); ++i) {
    steps.push_back(motionError(matched, i - 1, i));
  }
  return steps;
}

StepSummary summarize(const std::vector<StepError>& steps) {
  return {distributionOf(steps, &StepError::translation_m),
          distributionOf(steps, &StepError::rotation_rad)};
}

Drift finalDrift(const MatchedTrajectories& matched) {
  requireMatched(matched);
  if (matched.truth.empty()) return {};
  return motionError(matched, 0, matched.truth.size() - 1);
}

}  // namespace rotrocc
