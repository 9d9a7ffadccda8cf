#pragma once

#include <vector>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// Poses of the same body at the same times: truth[i] and estimate[i] correspond. They may start at
/// different poses, because only relative motions are compared.
struct MatchedTrajectories {
  Trajectory truth;
  Trajectory estimate;
};

/// Matches the poses by index. The excess poses of the longer trajectory are dropped.
MatchedTrajectories matchByIndex(const Trajectory& truth, const Trajectory& estimate);

/// Matches poses that are each other's nearest in time and at most `max_difference_s` apart. All
/// others are dropped. Stamps must increase, as readTrajectory() guarantees.
MatchedTrajectories matchByStamp(const Trajectory& truth,
                                 const Trajectory& estimate,
                                 double max_difference_s = 0.01);

/// Path length of the truth from the first pose to each pose [m]; one value per pose.
std::vector<double> pathLengths(const Trajectory& truth);

/// The segments that are compared. The defaults are those of the KITTI odometry devkit.
struct SegmentConfig {
  std::vector<double> lengths_m = {100, 200, 300, 400, 500, 600, 700, 800};
  int step = 10;  ///< a segment of each length starts at every step-th pose
};

/// The devkit's segments if the path is at least twice as long as the shortest of them, otherwise
/// segments of 5 to 40 m from every pose.
SegmentConfig fittingSegments(double path_m);

struct SegmentError {
  int first_pose = 0;
  double length_m = 0.0;     ///< as configured
  double speed_mps = 0.0;    ///< length divided by duration, from the stamps of the truth
  double translation = 0.0;  ///< [m/m]
  double rotation_rad_per_m = 0.0;
};

/// The errors of all segments, ordered by first pose, then length, as in the devkit: a segment ends
/// at the first pose whose path length from its start exceeds the given length. The error is
/// inv(motion of the estimate) * (motion of the truth), divided by the length.
///
/// Throws std::invalid_argument on a length that is not positive, a step below 1, stamps that do
/// not increase, and, as the functions below, trajectories of different sizes.
std::vector<SegmentError> segmentErrors(const MatchedTrajectories& matched,
                                        const SegmentConfig& config = {});

/// The mean error of a group of segments.
struct MeanError {
  double bin = 0.0;  ///< the length [m] or speed [m/s] of the group; 0 for all segments
  int segments = 0;
  double translation = 0.0;  ///< [m/m]; 0 if there are no segments
  double rotation_rad_per_m = 0.0;
};

/// The figures of the KITTI leaderboard, for one sequence.
MeanError meanError(const std::vector<SegmentError>& errors);

/// One entry per length that occurs, shortest first.
std::vector<MeanError> meanErrorByLength(const std::vector<SegmentError>& errors);

/// One entry for each speed, 2, 4, 6 ... m/s, that has segments less than 2 m/s away. A segment
/// counts for both neighboring speeds. Unlike the devkit's list, this one does not stop at 24 m/s.
std::vector<MeanError> meanErrorBySpeed(const std::vector<SegmentError>& errors);

/// Statistics of a non-negative quantity; all 0 if there are no values.
struct Distribution {
  double mean = 0.0;
  double rms = 0.0;
  double p95 = 0.0;  ///< 95 % of the values do not exceed this one
  double max = 0.0;
};

/// The motion error from one pose to the next.
struct StepError {
  double translation_m = 0.0;
  double rotation_rad = 0.0;
};

/// One error per pair of successive poses.
std::vector<StepError> stepErrors(const MatchedTrajectories& matched);

struct StepSummary {
  Distribution translation_m;
  Distribution rotation_rad;
};

StepSummary summarize(const std::vector<StepError>& steps);

/// The motion error from the first to the last pose.
using Drift = StepError;

/// Zero if there are no poses.
Drift finalDrift(const MatchedTrajectories& matched);

}  // namespace rotrocc
