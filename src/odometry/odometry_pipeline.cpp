#include "odometry/odometry_pipeline.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/sentence.h"
#include "common/stage_timer.h"
#include "motion/outlier_rejection.h"
#include "odometry/pair_check.h"

namespace rotrocc {
namespace {

/// The bias and the motion are estimated in turns, so often at most, until the bias that is applied
/// changes by less than this.
constexpr int kCalibrationRounds = 3;
constexpr double kCalibrationSettled_px = 0.02;

/// Two motions from one keyframe share the noise of its corners, half of that of their flow.
constexpr double kNotShared = 0.5;

/// Ends the work on a pair without a motion; what() is the reason, a sentence.
struct Lost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

}  // namespace

VisualOdometry::Pipeline::Pipeline(const Config& config)
    : config_(config),
      finder_(config.correspondence_finder, config.threads),
      motion_model_(config.motion_model),
      estimator_(config.motion_estimator),
      check_(config.motion_check),
      calibrator_(config.stereo_calibrator),
      selector_(config.keyframe_selector) {}

OdometryResult VisualOdometry::Pipeline::process(const StereoPair& pair,
                                                 const StereoCamera& camera,
                                                 const std::optional<Eigen::Isometry3d>& expected) {
  OdometryResult result;
  result.stamp_ns = pair.stamp_ns;
  found_.clear();
  const StageTimer timer(result.times.total_ms);
  try {
    advance(pair, camera, expected, result);
  } catch (const Lost& lost) {
    result.reason = lost.what();
  } catch (const std::exception& error) {
    last_.reset();  // what is kept may be the cause: the next pair is a first one
    result.reason = sentence("internal error: ", error.what());
    result.state = State::kLost;
  }
  result.counts = found_.counts;
  result.disparity_bias = calibrator_.bias();
  result.row_offset = rows_.offset();
  return result;
}

void VisualOdometry::Pipeline::reset() {
  last_.reset();
  motion_model_.reset();
  found_.clear();
}

void VisualOdometry::Pipeline::configure(const Config& config) {
  estimator_ = MotionEstimator(config.motion_estimator);  // first, as it may throw
  config_ = config;
  finder_ = CorrespondenceFinder(config.correspondence_finder, config.threads);
  motion_model_.configure(config.motion_model);
  check_ = MotionCheck(config.motion_check);
  calibrator_.configure(config.stereo_calibrator);
  selector_ = KeyframeSelector(config.keyframe_selector);
  keyframe_.frame.reset();  // its corners are of the old parameters
}

void VisualOdometry::Pipeline::advance(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const std::optional<Eigen::Isometry3d>& expected,
                                       OdometryResult& result) {
  checkInput(pair, camera);
  result.reason = whyRestart(pair, camera);
  const FramePtr current = takeFrame(pair, camera, result.times);
  if (!result.reason.empty()) {
    restart(current);
    result.state = State::kInitialising;
    return;
  }
  const std::string why_lost = findMotion(current, expected, result);
  if (!why_lost.empty()) {
    // The fault may be this pair's or the last one's: the next one is compared with both.
    lost_ = current;
    throw Lost(why_lost);
  }
  accept(current, result);
}

void VisualOdometry::Pipeline::checkInput(const StereoPair& pair,
                                          const StereoCamera& camera) const {
  try {
    camera.check();
  } catch (const std::invalid_argument& error) {
    throw Lost(error.what());
  }
  const std::string why_unusable = whyUnusable(pair, camera);
  if (!why_unusable.empty()) throw Lost(why_unusable);
  if (!last_) return;
  const std::int64_t newest_ns = (lost_ ? lost_ : last_)->stamp_ns;
  if (pair.stamp_ns <= newest_ns) {
    throw Lost(sentence("the stamp ",
                        pair.stamp_ns,
                        " ns is not later than that of the pair before, ",
                        newest_ns,
                        " ns"));
  }
}

/// Why the pair cannot be compared with an earlier one; empty if it can.
std::string VisualOdometry::Pipeline::whyRestart(const StereoPair& pair,
                                                 const StereoCamera& camera) const {
  if (!last_) return "first pair";
  if (camera != camera_) return "the camera has changed";
  const double gap_s = seconds(pair.stamp_ns - (lost_ ? lost_ : last_)->stamp_ns);
  if (gap_s <= config_.max_gap_s) return "";
  return sentence("no pair for ", gap_s, " s, more than max_gap_s = ", config_.max_gap_s);
}

FramePtr VisualOdometry::Pipeline::takeFrame(const StereoPair& pair,
                                             const StereoCamera& camera,
                                             StageTimes& times) {
  const StageTimer timer(times.pyramids_ms);
  if (camera != camera_) {
    calibrator_.reset();
    rows_.reset();
  }
  calibrator_.advance();
  camera_ = camera;
  return finder_.makeFrame(pair);
}

void VisualOdometry::Pipeline::restart(const FramePtr& current) {
  last_ = current;
  lost_.reset();
  keyframe_.frame.reset();
  motion_model_.reset();
}

void VisualOdometry::Pipeline::makeKeyframe(const FramePtr& frame, StageTimes& times) {
  keyframe_.frame = frame;
  keyframe_.T_keyframe_last = {};
  keyframe_.first_inliers = 0;
  {
    const StageTimer timer(times.corners_ms);
    finder_.findCorners(keyframe_);
  }
  const StageTimer timer(times.disparity_ms);
  finder_.findDepths(calibrator_.correct(camera_), keyframe_);
}

/// Measures the motion against the keyframe, else against the last frame, else against the one that
/// was lost after it, whose pose is taken to be that of the last one.
std::string VisualOdometry::Pipeline::findMotion(const FramePtr& current,
                                                 const std::optional<Eigen::Isometry3d>& expected,
                                                 OdometryResult& result) {
  result.dt_s = seconds(current->stamp_ns - last_->stamp_ns);
  const auto T_last_cur = expected ? expected : motion_model_.predict(result.dt_s);
  if (!keyframe_.frame) makeKeyframe(last_, result.times);
  std::string why_lost = findMotionFromKeyframe(*current, T_last_cur, result.times);
  if (!why_lost.empty() && keyframe_.frame != last_) {
    makeKeyframe(last_, result.times);
    why_lost = findMotionFromKeyframe(*current, T_last_cur, result.times);
  }
  if (!why_lost.empty() && lost_) {
    last_ = std::move(lost_);
    lost_.reset();
    motion_model_.reset();
    result.dt_s = seconds(current->stamp_ns - last_->stamp_ns);
    makeKeyframe(last_, result.times);
    why_lost = findMotionFromKeyframe(*current, {}, result.times);
  }
  return why_lost;
}

/// With a prediction one round is enough. Without one, or where it proves wrong, features tracked
/// from a wrong place may agree on a wrong motion: predict, track and estimate until it settles.
std::string VisualOdometry::Pipeline::findMotionFromKeyframe(
    const StereoFrame& current,
    const std::optional<Eigen::Isometry3d>& T_last_cur,
    StageTimes& times) {
  std::string why_lost;
  Eigen::Isometry3d T_keyframe_cur = keyframe_.T_keyframe_last.T;
  if (T_last_cur) {
    why_lost = tryMotion(current, T_keyframe_cur * *T_last_cur, true, times);
    if (why_lost.empty()) {
      calibrate(sinceKeyframe_s(current), times);
      return "";
    }
  }
  for (int round = 0; round < config_.startup_rounds; ++round) {
    why_lost = tryMotion(current, T_keyframe_cur, false, times);
    if (!found_.estimate.valid) break;
    const Eigen::Isometry3d& T_found = found_.estimate.T_prev_cur;
    const double shift_px = finder_.medianShift(found_.camera, keyframe_, T_keyframe_cur, T_found);
    T_keyframe_cur = T_found;
    if (shift_px < config_.startup_settled_px) break;
  }
  if (why_lost.empty()) calibrate(sinceKeyframe_s(current), times);
  return why_lost;
}

std::string VisualOdometry::Pipeline::tryMotion(const StereoFrame& current,
                                                const Eigen::Isometry3d& T_keyframe_cur,
                                                bool is_prediction,
                                                StageTimes& times) {
  found_.camera = calibrator_.correct(camera_);
  {
    const StageTimer timer(times.tracking_ms);
    found_.counts.tracked = finder_.find(
        found_.camera, keyframe_, current, T_keyframe_cur, is_prediction, found_.features);
    found_.counts.corners = static_cast<int>(keyframe_.corners.size());
    found_.counts.with_depth = static_cast<int>(keyframe_.points.size());
    found_.counts.consistent = static_cast<int>(found_.features.size());
  }
  const StageTimer timer(times.estimation_ms);
  return estimate(T_keyframe_cur, is_prediction, sinceKeyframe_s(current), found_);
}

std::string VisualOdometry::Pipeline::estimate(const Eigen::Isometry3d& T_keyframe_cur,
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

/// The features show the rig's bias as well as the motion: both are found in turns.
void VisualOdometry::Pipeline::calibrate(double dt_s, StageTimes& times) {
  const StageTimer timer(times.estimation_ms);
  for (int round = 0; round < kCalibrationRounds; ++round) {
    const MotionEstimator::Estimate& found = found_.estimate;
    calibrator_.observe(found_.camera, found_.features, found.rotation_inliers, found.T_prev_cur);
    const StereoCamera corrected = calibrator_.correct(camera_);
    if (std::abs(corrected.cx_right - found_.camera.cx_right) < kCalibrationSettled_px) return;
    recalibrated_ = found_;
    recalibrated_.camera = corrected;
    triangulate(corrected, recalibrated_.features);
    if (!estimate(found.T_prev_cur, true, dt_s, recalibrated_).empty()) return;
    std::swap(found_, recalibrated_);
  }
}

double VisualOdometry::Pipeline::sinceKeyframe_s(const StereoFrame& current) const {
  return seconds(current.stamp_ns - keyframe_.frame->stamp_ns);
}

void VisualOdometry::Pipeline::accept(const FramePtr& current, OdometryResult& result) {
  const MotionEstimator::Estimate& estimate = found_.estimate;
  finder_.compareRows(*current, found_.features, estimate.rotation_inliers, row_differences_px_);
  rows_.observe(row_differences_px_);

  result.flow_noise_px = estimate.flow_noise_px;
  result.keyframe_stamp_ns = keyframe_.frame->stamp_ns;
  result.T_keyframe_cur = {estimate.T_prev_cur,
                           estimate.covariance + calibrator_.motionCovariance()};
  UncertainTransform step = compose(inverse(keyframe_.T_keyframe_last), result.T_keyframe_cur);
  if (keyframe_.frame != last_) step.covariance *= kNotShared;
  result.T_prev_cur = step.T;
  result.covariance = step.covariance;
  result.reason = check_.whyDegraded(estimate);
  if (const auto expected = motion_model_.predict(result.dt_s); expected && result.reason.empty()) {
    result.reason = check_.whyJump(step, *expected, result.dt_s);
  }
  result.state = result.reason.empty() ? State::kOk : State::kDegraded;
  motion_model_.update(step.T, result.dt_s);

  last_ = current;
  lost_.reset();
  keyframe_.T_keyframe_last = result.T_keyframe_cur;
  const bool serves = result.state == State::kOk && selector_.keeps(found_.camera,
                                                                    found_.features,
                                                                    estimate.rotation_inliers,
                                                                    estimate.T_prev_cur,
                                                                    keyframe_);
  if (!serves) keyframe_.frame.reset();
}

}  // namespace rotrocc
