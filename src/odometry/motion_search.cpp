#include "odometry/motion_search.h"

#include <cmath>
#include <utility>

#include "common/stage_timer.h"
#include "features/descriptor_matcher.h"
#include "motion/consensus_motion.h"
#include "motion/feature_errors.h"
#include "paper/paper_estimator.h"

namespace rotrocc {
namespace {

/// The motion is estimated once more if the applied bias changes by more than this.
constexpr double kCalibrationSettled_px = 0.02;

/// Tries from one start. A motion that does not converge in these wanders about, and leaves the
/// other starts none.
constexpr int kMaxSteps = 3;

/// A smaller share of the keyframe's features may agree by chance, or be those of an object: there
/// may be a better start.
constexpr double kConvincingShare = 0.25;

/// Features on a large object that moves with the camera agree on a start at rest: they must be
/// more than this many times those that agree on the prediction.
constexpr double kOverPrediction = 2.0;

std::unique_ptr<MotionEstimator> makeEstimator(const OdometryConfig& config) {
  config.check();
  if (config.isPaper()) return std::make_unique<PaperEstimator>(config.motion_estimator.criterion);
  return std::make_unique<MotionEstimator>();
}

}  // namespace

MotionSearch::MotionSearch(const OdometryConfig& config)
    : window_radius_px_(config.correspondence_finder.feature_tracker.window_radius_px),
      max_tries_(config.max_tries),
      estimator_(makeEstimator(config)),
      check_(config.motion_check, config.isPaper()),
      matcher_(config.correspondence_finder.stereo_matcher) {}

bool MotionSearch::find(const Frames& frames, const Start& start, Hypothesis& found) {
  // A window finds what is as far away as it reaches in the smallest image. Without a prediction,
  // many find something else so far away: they are tracked again from where they belong.
  const std::size_t halvings = start.is_prediction ? frames.current.left.size() - 1 : 0;
  const double reach_px = frames.camera.window_scale * window_radius_px_ * (1 << halvings);
  std::optional<Eigen::Isometry3d> prediction;
  if (start.is_prediction) prediction = start.T_keyframe_cur;
  Start next = start;
  for (int step = 0; step < kMaxSteps && found.counts.tries < max_tries_; ++step) {
    const int tries = found.counts.tries + 1;
    tryMotion(frames, next, prediction, tried_);
    const Eigen::Isometry3d T_found = tried_.estimate.T_keyframe_cur;
    const bool is_usable = tried_.estimate.valid && tried_.counts.consistent >= kMinInliers;
    if (isBetter(tried_, found)) std::swap(tried_, found);
    found.counts.tries = tries;
    if (!is_usable) return false;
    const double shift_px =
        frames.finder.medianShift(frames.camera, frames.keyframe, next.T_keyframe_cur, T_found);
    // Features that were searched where they are do not agree better after another search.
    const bool was_predicted = step == 0 && start.is_prediction;
    if (shift_px < reach_px) {
      return hasMinimumSupport(found) && (was_predicted || !check_.whyFewAgree(found));
    }
    next.T_keyframe_cur = T_found;
  }
  return false;
}

bool MotionSearch::hasMinimumSupport(const Hypothesis& found) {
  return found.isAccepted() &&
         found.counts.rotation_inliers >= kConvincingShare * found.counts.with_depth &&
         !check_.whyNotAtRest(found);
}

bool MotionSearch::isBetter(const Hypothesis& a, const Hypothesis& b) {
  if (!b.isAccepted()) return true;
  if (!a.isAccepted()) return false;
  const bool b_is_likelier = b.has_prediction && !a.has_prediction && hasMinimumSupport(b);
  const double factor = b_is_likelier ? kOverPrediction : 1.0;
  return a.counts.rotation_inliers > factor * b.counts.rotation_inliers;
}

std::optional<MotionSearch::Start> MotionSearch::recognize(const Frames& frames) {
  const StageTimer timer(frames.times.tracking_ms);
  const Correspondences seen =
      matchDescriptors(frames.camera, frames.keyframe, frames.current, matcher_);
  const auto T_keyframe_cur = consensusMotion(frames.camera, seen, kOfRecognized);
  if (!T_keyframe_cur) return std::nullopt;
  return Start{*T_keyframe_cur, false};
}

void MotionSearch::tryMotion(const Frames& frames,
                             const Start& start,
                             const std::optional<Eigen::Isometry3d>& prediction,
                             Hypothesis& hypothesis) {
  hypothesis.camera = frames.camera;
  hypothesis.has_prediction = start.is_prediction;
  StageCounts& counts = hypothesis.counts;
  {
    const StageTimer timer(frames.times.tracking_ms);
    counts.tracked = frames.finder.find(
        frames.camera, frames.keyframe, frames.current, start.T_keyframe_cur, hypothesis.features);
    hypothesis.contrast_gain = frames.finder.stereoGain();
  }
  counts.corners = static_cast<int>(frames.keyframe.corners.size());
  counts.with_depth = static_cast<int>(frames.keyframe.points.size());
  counts.consistent = static_cast<int>(hypothesis.features.size());
  const StageTimer timer(frames.times.estimation_ms);
  estimate(frames, start.T_keyframe_cur, prediction, hypothesis);
}

void MotionSearch::estimate(const Frames& frames,
                            const Eigen::Isometry3d& initial,
                            const std::optional<Eigen::Isometry3d>& prediction,
                            Hypothesis& hypothesis) {
  MotionEstimate& estimate = hypothesis.estimate;
  if (hypothesis.counts.consistent < kMinInliers) {  // it is rejected, and would take long
    estimate.valid = false;
    estimate.rotation_inliers.assign(hypothesis.features.size(), 0);
    estimate.translation_inliers = estimate.rotation_inliers;
  } else {
    estimate = estimator_->estimate(hypothesis.camera,
                                    hypothesis.features,
                                    initial,
                                    secondsBetween(*frames.keyframe.frame, frames.current),
                                    prediction);
  }
  hypothesis.counts.rotation_inliers = count(estimate.rotation_inliers);
  hypothesis.counts.translation_inliers =
      estimate.has_translation_stage ? count(estimate.translation_inliers) : 0;
  hypothesis.why_lost = check_.whyLost(hypothesis, frames.keyframe.T_keyframe_last.T, frames.dt_s);
}

void MotionSearch::calibrate(const Frames& frames, RigEstimate& rig, Hypothesis& found) {
  const StageTimer timer(frames.times.estimation_ms);
  rig.observeBias(found);
  const StereoCamera corrected = rig.correctedCamera();
  if (std::abs(corrected.cx_right - found.camera.cx_right) < kCalibrationSettled_px) return;
  recalibrated_ = found;
  recalibrated_.camera = corrected;
  triangulate(corrected, recalibrated_.features);
  const Eigen::Isometry3d T_found = found.estimate.T_keyframe_cur;
  estimate(frames, T_found, T_found, recalibrated_);
  if (recalibrated_.isAccepted()) std::swap(found, recalibrated_);
}

}  // namespace rotrocc
