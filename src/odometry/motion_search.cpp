#include "odometry/motion_search.h"

#include <cmath>
#include <utility>

#include "common/stage_timer.h"
#include "motion/outlier_rejection.h"

namespace rotrocc {
namespace {

/// Bias and motion are estimated alternately, until the applied bias changes by less than
/// kCalibrationSettled_px, at most kCalibrationRounds times.
constexpr int kCalibrationRounds = 3;
constexpr double kCalibrationSettled_px = 0.02;

}  // namespace

MotionSearch::MotionSearch(const OdometryConfig& config)
    : settled_px_(config.settled_px),
      estimator_(config.motion_estimator, config.motion_check.min_inliers),
      check_(config.motion_check) {}

std::string MotionSearch::find(CorrespondenceFinder& finder,
                               const StereoCamera& camera,
                               const Keyframe& keyframe,
                               const StereoFrame& current,
                               const std::optional<Eigen::Isometry3d>& T_last_cur,
                               int most_tries,
                               Hypothesis& found,
                               StageTimes& times) {
  found.camera = camera;
  Eigen::Isometry3d T_keyframe_cur = keyframe.T_keyframe_last.T;
  std::string why_lost;
  if (T_last_cur) {
    const Eigen::Isometry3d T_predicted = T_keyframe_cur * *T_last_cur;
    why_lost = tryMotion(finder, keyframe, current, T_predicted, true, found, times);
    if (why_lost.empty()) return "";
  }
  do {
    why_lost = tryMotion(finder, keyframe, current, T_keyframe_cur, false, found, times);
    if (!found.estimate.valid) break;
    const Eigen::Isometry3d& T_found = found.estimate.T_keyframe_cur;
    const double shift_px = finder.medianShift(camera, keyframe, T_keyframe_cur, T_found);
    T_keyframe_cur = T_found;
    if (shift_px < settled_px_) break;
  } while (found.counts.tries < most_tries);
  return why_lost;
}

std::string MotionSearch::tryMotion(CorrespondenceFinder& finder,
                                    const Keyframe& keyframe,
                                    const StereoFrame& current,
                                    const Eigen::Isometry3d& T_keyframe_cur,
                                    bool is_prediction,
                                    Hypothesis& found,
                                    StageTimes& times) {
  ++found.counts.tries;
  {
    const StageTimer timer(times.tracking_ms);
    found.counts.tracked =
        finder.find(found.camera, keyframe, current, T_keyframe_cur, is_prediction, found.features);
  }
  found.counts.corners = static_cast<int>(keyframe.corners.size());
  found.counts.with_depth = static_cast<int>(keyframe.points.size());
  found.counts.consistent = static_cast<int>(found.features.size());
  const StageTimer timer(times.estimation_ms);
  return estimate(T_keyframe_cur, is_prediction, secondsBetween(*keyframe.frame, current), found);
}

std::string MotionSearch::estimate(const Eigen::Isometry3d& T_keyframe_cur,
                                   bool is_prediction,
                                   double dt_s,
                                   Hypothesis& hypothesis) {
  MotionEstimator::Estimate& estimate = hypothesis.estimate;
  estimate = estimator_.estimate(
      hypothesis.camera, hypothesis.features, T_keyframe_cur, dt_s, is_prediction);
  hypothesis.counts.rotation_inliers = count(estimate.rotation_inliers);
  hypothesis.counts.translation_inliers =
      estimate.has_translation_stage ? count(estimate.translation_inliers) : 0;
  return check_.whyLost(estimate, dt_s);
}

void MotionSearch::calibrate(const StereoCamera& camera,
                             double dt_s,
                             StereoCalibrator& calibrator,
                             Hypothesis& found,
                             StageTimes& times) {
  const StageTimer timer(times.estimation_ms);
  for (int round = 0; round < kCalibrationRounds; ++round) {
    const MotionEstimator::Estimate& estimated = found.estimate;
    calibrator.observe(
        found.camera, found.features, estimated.rotation_inliers, estimated.T_keyframe_cur);
    const StereoCamera corrected = calibrator.correct(camera);
    if (std::abs(corrected.cx_right - found.camera.cx_right) < kCalibrationSettled_px) return;
    recalibrated_ = found;
    recalibrated_.camera = corrected;
    triangulate(corrected, recalibrated_.features);
    if (!estimate(estimated.T_keyframe_cur, true, dt_s, recalibrated_).empty()) return;
    std::swap(found, recalibrated_);
  }
}

}  // namespace rotrocc
