#pragma once

#include <vector>

#include "rotrocc/trajectory.h"

namespace rotrocc {

/// Poses of the same moments: truth[i] and estimate[i] belong together. The two may start anywhere,
/// as only relative motions are compared, but must be poses of the same body with the same axes.
struct MatchedTrajectories {
  Trajectory truth;
  Trajectory estimate;
};

/// Matches pose by pose from the first one on and drops what one of the two has in excess.
MatchedTrajectories matchByIndex(const Trajectory& truth, const Trajectory& estimate);

/// Matches the poses that are each other's nearest in time, at most `max_difference_s` apart; the
/// others are dropped. Stamps must increase, as readTrajectory() guarantees.
MatchedTrajectories matchByStamp(const Trajectory& truth,
                                 const Trajectory& estimate,
                                 double max_difference_s = 0.01);

/// The path of the truth from the first pose to each, in metres; as many as there are poses.
std::vector<double> pathLengths(const Trajectory& truth);

/// Which parts of a trajectory are compared; the defaults are those of the KITTI odometry devkit.
struct SegmentConfig {
  std::vector<double> lengths_m = {100, 200, 300, 400, 500, 600, 700, 800};
  int step = 10;  ///< a segment of each length begins at every step-th pose
};

/// Those of the devkit if the path has room for two of its shortest, else 5 to 40 m from every
/// pose.
SegmentConfig fittingSegments(double path_m);

/// The error of the motion over one segment of the path.
struct SegmentError {
  int first_pose = 0;
  double length_m = 0.0;     ///< as configured
  double speed_mps = 0.0;    ///< length over duration, by the stamps of the truth
  double translation = 0.0;  ///< [m/m]
  double rotation_rad_per_m = 0.0;
};

/// The errors of all segments, by first pose, then length; the definition is that of the devkit: a
/// segment ends at the first pose whose path from the segment's begin is longer than the length,
/// and its error is inv(motion of the estimate) * (motion of the truth), divided by the length.
/// (The devkit has no stamps: it gets the speed from the count of poses at 10 Hz, the last one
/// included.) Throws std::invalid_argument on a length that is not positive, a step below 1, stamps
/// that do not increase, and, as the functions below that take them, on trajectories of different
/// sizes.
std::vector<SegmentError> segmentErrors(const MatchedTrajectories& matched,
                                        const SegmentConfig& config = {});

/// The mean of some segments' errors.
struct MeanError {
  double bin = 0.0;  ///< the length [m] or the speed [m/s] that the segments share; 0 for all
  int segments = 0;
  double translation = 0.0;  ///< [m/m]; 0 if there are no segments
  double rotation_rad_per_m = 0.0;
};

/// The figures of the KITTI leaderboard for one sequence.
MeanError meanError(const std::vector<SegmentError>& errors);

/// One entry for each length that occurs, shortest first.
std::vector<MeanError> meanErrorByLength(const std::vector<SegmentError>& errors);

/// One entry for each of the devkit's speeds, 2, 4, 6 ... m/s, that has segments less than 2 m/s
/// away; so a segment counts for both its neighbours. Not ended at 24 m/s, as the devkit's list is.
std::vector<MeanError> meanErrorBySpeed(const std::vector<SegmentError>& errors);

/// How a positive quantity is distributed; all 0 if there are no values.
struct Distribution {
  double mean = 0.0;
  double rms = 0.0;
  double p95 = 0.0;  ///< 95 % of the values are not above this one
  double max = 0.0;
};

/// The error of the motion from one pose to the next.
struct StepError {
  double translation_m = 0.0;
  double rotation_rad = 0.0;
};

/// One less than there are poses.
std::vector<StepError> stepErrors(const MatchedTrajectories& matched);

/// How the errors of steps are distributed.
struct StepSummary {
  Distribution translation_m;
  Distribution rotation_rad;
};

StepSummary summarize(const std::vector<StepError>& steps);

/// The error of the motion from the first to the last pose.
struct Drift {
  double translation_m = 0.0;
  double rotation_rad = 0.0;
};

/// Zero if there are no poses.
Drift finalDrift(const MatchedTrajectories& matched);

}  // namespace rotrocc
