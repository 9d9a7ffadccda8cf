#include "odometry/motion_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/stage_timer.h"
#include "motion/consensus_motion.h"
#include "motion/outlier_rejection.h"

namespace rotrocc {
namespace {

/// The motion is estimated once more if the applied bias changes by more than this.
constexpr double kCalibrationSettled_px = 0.02;

/// Features that a start at rest begins with. Tracking is what a start costs, and these find the
/// motion as surely as all: RANSAC needs no more.
constexpr std::size_t kScouts = 200;

/// Features that are searched while the camera stays at rest: the noise of its pose does not
/// accumulate.
constexpr std::size_t kFeaturesAtRest = 150;

/// If the median feature has moved by less since the keyframe, the camera is at rest [px]. Noise is
/// a tenth of it.
constexpr double kRest_px = 0.3;

/// If fewer features agree that the camera is at rest, it may be an object that is.
constexpr double kAgreeAtRest = 0.9;

/// Whether to prefer hypothesis `a`.
bool isBetter(const Hypothesis& a, const Hypothesis& b) {
  if (!b.isAccepted()) return true;
  return a.isAccepted() && a.counts.rotation_inliers > b.counts.rotation_inliers;
}

}  // namespace

MotionSearch::MotionSearch(const OdometryConfig& config)
    : tracker_(config.correspondence_finder.feature_tracker),
      least_features_(config.motion_check.min_inliers),
      settled_px_(config.settled_px),
      estimator_(config.motion_estimator, config.motion_check.min_inliers),
      check_(config.motion_check, config.motion_estimator.noise_ratio),
      prediction_error_(tracker_) {}

void MotionSearch::find(const Frames& frames,
                        const Expectation& expected,
                        int most_tries,
                        Hypothesis& found,
                        StageTimes& times) {
  const int tries = found.counts.tries;
  found.clear();
  found.counts.tries = tries;
  search(frames, expected, most_tries, found, times);
  found.counts.corners = static_cast<int>(frames.keyframe.corners.size());
  found.counts.with_depth = static_cast<int>(frames.keyframe.points.size());
}

void MotionSearch::search(const Frames& frames,
                          const Expectation& expected,
                          int most_tries,
                          Hypothesis& found,
                          StageTimes& times) {
  const Eigen::Isometry3d& T_keyframe_last = frames.keyframe.T_keyframe_last.T;
  const Start at_rest = startAt(T_keyframe_last, {});
  if (!expected.T_last_cur && !expected.R_last_cur) {
    findWithoutExpectation(frames, at_rest, most_tries, found, times);
    return;
  }
  const Start start = startAt(T_keyframe_last, expected);
  if (!expected.T_last_cur || !staysAtRest(frames, start, found, times)) {
    const bool is_settled = settle(frames, start, most_tries, found, times);
    if (!(is_settled && found.isAccepted()) && found.counts.tries < most_tries) {
      settle(frames, at_rest, most_tries, found, times);
    }
  }
  if (!found.isAccepted() || !start.is_prediction) return;
  prediction_error_.observe(frames.finder.medianShift(
      frames.camera, frames.keyframe, start.T_keyframe_cur, found.estimate.T_keyframe_cur));
}

MotionSearch::Start MotionSearch::startAt(const Eigen::Isometry3d& T_keyframe_last,
                                          const Expectation& expected) const {
  if (expected.T_last_cur) {
    return {T_keyframe_last * *expected.T_last_cur, prediction_error_.levels(), true, false};
  }
  Start start = {T_keyframe_last, tracker_.startup_levels, false, true};
  if (expected.R_last_cur) start.T_keyframe_cur.rotate(*expected.R_last_cur);
  return start;
}

/// Whether the camera is still where it was in the keyframe, according to a part of the features.
bool MotionSearch::staysAtRest(const Frames& frames,
                               const Start& start,
                               Hypothesis& found,
                               StageTimes& times) {
  if (frames.keyframe.points.size() < 2 * kFeaturesAtRest) return false;
  const auto isAtRest = [&](const Eigen::Isometry3d& T_keyframe_cur) {
    return frames.finder.medianShift(
               frames.camera, few_, Eigen::Isometry3d::Identity(), T_keyframe_cur) < kRest_px;
  };
  thinOut(frames.keyframe, kFeaturesAtRest, few_);
  if (!isAtRest(start.T_keyframe_cur)) return false;
  tryFew(frames, start, times);
  const bool all_agree = tried_.counts.rotation_inliers >= kAgreeAtRest * tried_.counts.consistent;
  if (!tried_.isAccepted() || !all_agree) return false;
  if (!isAtRest(tried_.estimate.T_keyframe_cur)) return false;
  tried_.counts.tries = found.counts.tries + 1;
  std::swap(tried_, found);
  return true;
}

/// Starts where a part of the features leads, and at rest if that fails.
void MotionSearch::findWithoutExpectation(const Frames& frames,
                                          const Start& at_rest,
                                          int most_tries,
                                          Hypothesis& best,
                                          StageTimes& times) {
  Start scouted = at_rest;
  if (scout(frames, scouted, times)) {
    // The last try is kept for the start at rest, unless it is the only one.
    const int others = std::max(best.counts.tries + 1, most_tries - 1);
    const bool is_settled = settle(frames, scouted, others, best, times);
    if ((is_settled && best.isAccepted()) || best.counts.tries >= most_tries) return;
  }
  settle(frames, at_rest, most_tries, best, times);
}

/// Moves `start` to the motion of a part of the features. Returns false if they are too few, or
/// find none.
bool MotionSearch::scout(const Frames& frames, Start& start, StageTimes& times) {
  if (frames.keyframe.points.size() < 2 * kScouts) return false;
  thinOut(frames.keyframe, kScouts, few_);
  tryFew(frames, start, times);
  start.T_keyframe_cur = tried_.estimate.T_keyframe_cur;
  start.needs_consensus = false;
  return tried_.isAccepted();
}

/// Tries a motion with the features of `few_`.
void MotionSearch::tryFew(const Frames& frames, const Start& start, StageTimes& times) {
  few_.frame = frames.keyframe.frame;
  tryMotion({frames.finder, frames.camera, few_, frames.current, frames.shared_ratio},
            start,
            tried_,
            times);
  few_.frame.reset();  // its images are reused when nobody else has it
}

/// Tracks and estimates repeatedly, each time starting from the last result. `best` becomes the
/// best hypothesis of these and itself. Returns whether it settled.
bool MotionSearch::settle(
    const Frames& frames, Start start, int most_tries, Hypothesis& best, StageTimes& times) {
  for (;;) {
    const int tries = best.counts.tries + 1;
    tryMotion(frames, start, tried_, times);
    const Eigen::Isometry3d T_found = tried_.estimate.T_keyframe_cur;
    // The features near a wrong prediction lead nowhere. A start at rest is better.
    const bool is_usable =
        start.is_prediction ? tried_.isAccepted()
                            : tried_.estimate.valid && tried_.counts.consistent >= least_features_;
    if (isBetter(tried_, best)) std::swap(tried_, best);
    best.counts.tries = tries;
    if (!is_usable) return false;
    const double shift_px =
        frames.finder.medianShift(frames.camera, frames.keyframe, start.T_keyframe_cur, T_found);
    if (shift_px < settled_px_) return true;
    if (tries >= most_tries) return false;
    start.T_keyframe_cur = T_found;
    if (start.is_prediction) start.levels = tracker_.levels;
  }
}

void MotionSearch::tryMotion(const Frames& frames,
                             const Start& start,
                             Hypothesis& hypothesis,
                             StageTimes& times) {
  hypothesis.camera = frames.camera;
  hypothesis.has_prediction = start.is_prediction;
  hypothesis.shared_ratio = frames.shared_ratio;
  StageCounts& counts = hypothesis.counts;
  {
    const StageTimer timer(times.tracking_ms);
    counts.tracked = frames.finder.find(frames.camera,
                                        frames.keyframe,
                                        frames.current,
                                        start.T_keyframe_cur,
                                        start.levels,
                                        hypothesis.features);
    hypothesis.exposure_gain = frames.finder.stereoGain();
  }
  counts.searched = static_cast<int>(frames.keyframe.points.size());
  counts.consistent = static_cast<int>(hypothesis.features.size());
  const StageTimer timer(times.estimation_ms);
  const double dt_s = secondsBetween(*frames.keyframe.frame, frames.current);
  if (counts.consistent < least_features_) return rejectUnseen(dt_s, hypothesis);
  if (!start.needs_consensus) return estimate(start.T_keyframe_cur, true, dt_s, hypothesis);
  const auto consensus = consensusMotion(frames.camera, hypothesis.features);
  estimate(consensus.value_or(start.T_keyframe_cur), consensus.has_value(), dt_s, hypothesis);
}

/// Rejects a hypothesis with too few features without an estimate, which would take long.
void MotionSearch::rejectUnseen(double dt_s, Hypothesis& hypothesis) {
  hypothesis.estimate.valid = false;
  hypothesis.estimate.rotation_inliers.assign(hypothesis.features.size(), 0);
  hypothesis.estimate.translation_inliers.assign(hypothesis.features.size(), 0);
  hypothesis.counts.rotation_inliers = hypothesis.counts.translation_inliers = 0;
  hypothesis.why_lost = check_.whyLost(hypothesis.estimate, dt_s);
}

void MotionSearch::estimate(const Eigen::Isometry3d& T_keyframe_cur,
                            bool is_prediction,
                            double dt_s,
                            Hypothesis& hypothesis) {
  MotionEstimator::Estimate& estimate = hypothesis.estimate;
  estimate = estimator_.estimate(hypothesis.camera,
                                 hypothesis.features,
                                 T_keyframe_cur,
                                 dt_s,
                                 is_prediction,
                                 hypothesis.shared_ratio);
  hypothesis.counts.rotation_inliers = count(estimate.rotation_inliers);
  hypothesis.counts.translation_inliers =
      estimate.has_translation_stage ? count(estimate.translation_inliers) : 0;
  hypothesis.why_lost = check_.whyLost(estimate, dt_s);
}

void MotionSearch::calibrate(const StereoCamera& camera,
                             double dt_s,
                             StereoCalibrator& calibrator,
                             Hypothesis& found,
                             StageTimes& times) {
  const StageTimer timer(times.estimation_ms);
  const MotionEstimator::Estimate& estimated = found.estimate;
  consistent_.assign(found.features.size(), 1);
  calibrator.observe(
      found.camera, found.features, consistent_, estimated.T_keyframe_cur, found.shared_ratio);
  const StereoCamera corrected = calibrator.correct(camera);
  if (std::abs(corrected.cx_right - found.camera.cx_right) < kCalibrationSettled_px) return;
  recalibrated_ = found;
  recalibrated_.camera = corrected;
  triangulate(corrected, recalibrated_.features);
  estimate(estimated.T_keyframe_cur, true, dt_s, recalibrated_);
  if (recalibrated_.isAccepted()) std::swap(found, recalibrated_);
}

}  // namespace rotrocc
