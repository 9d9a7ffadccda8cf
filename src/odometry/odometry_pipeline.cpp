#include "odometry/odometry_pipeline.h"

#include <cmath>
#include <stdexcept>

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
      noise_(config.noise_estimator, config.motion_estimator.noise_ratio),
      calibrator_(config.stereo_calibrator),
      selector_(config.keyframe_selector) {}

OdometryResult VisualOdometry::Pipeline::process(const StereoPair& pair,
                                                 const StereoCamera& camera,
                                                 const std::optional<Eigen::Isometry3d>& expected) {
  OdometryResult result;
  result.stamp_ns = pair.stamp_ns;
  forgetFeatures();
  const StageTimer timer(result.times.total_ms);
  try {
    advance(pair, camera, expected, result);
  } catch (const Lost& lost) {
    giveUp(lost.what(), result);
  } catch (const std::exception& error) {
    has_last_ = false;  // what is kept may be the cause: the next pair is a first one
    giveUp(sentence("internal error: ", error.what()), result);
  }
  result.disparity_bias = calibrator_.bias();
  result.row_offset = rows_.offset();
  result.noise = noise_.noise();
  return result;
}

void VisualOdometry::Pipeline::reset() {
  has_last_ = false;
  motion_model_.reset();
  forgetFeatures();
}

void VisualOdometry::Pipeline::configure(const Config& config) {
  estimator_ = MotionEstimator(config.motion_estimator);  // first, as it may throw
  config_ = config;
  finder_.configure(config.correspondence_finder, config.threads);
  motion_model_.configure(config.motion_model);
  check_ = MotionCheck(config.motion_check);
  noise_.configure(config.noise_estimator, config.motion_estimator.noise_ratio);
  calibrator_.configure(config.stereo_calibrator);
  selector_ = KeyframeSelector(config.keyframe_selector);
  keyframe_serves_ = false;  // its corners are of the old parameters
}

void VisualOdometry::Pipeline::advance(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const std::optional<Eigen::Isometry3d>& expected,
                                       OdometryResult& result) {
  checkInput(pair, camera);
  result.reason = whyStart(pair, camera);
  takePair(pair, camera, result.times);
  if (!result.reason.empty()) {
    startFromCurrent();
    result.state = State::kInitialising;
    return;
  }
  result.dt_s = seconds(stamp_ns_ - last_stamp_ns_);
  const auto T_last_cur = expected ? expected : motion_model_.predict(result.dt_s);
  if (!keyframe_serves_) makeKeyframeOfLast(result);
  std::string why_lost = findMotion(T_last_cur, result);
  if (!why_lost.empty() && keyframe_stamp_ns_ != last_stamp_ns_) {
    makeKeyframeOfLast(result);
    why_lost = findMotion(T_last_cur, result);
  }
  if (!why_lost.empty() && has_lost_) {
    takeUpLost(result);
    why_lost = findMotion({}, result);
  }
  if (!why_lost.empty()) {
    // The fault may be this pair's or the last one's: the next one is compared with both.
    finder_.setAside();
    has_lost_ = true;
    lost_stamp_ns_ = stamp_ns_;
    throw Lost(why_lost);
  }
  accept(result);
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
  if (has_last_ && pair.stamp_ns <= stamp_ns_) {
    throw Lost(sentence("the stamp ",
                        pair.stamp_ns,
                        " ns is not later than that of the pair before, ",
                        stamp_ns_,
                        " ns"));
  }
}

/// Why the pair cannot be compared with an earlier one; empty if it can.
std::string VisualOdometry::Pipeline::whyStart(const StereoPair& pair,
                                               const StereoCamera& camera) const {
  if (!has_last_) return "first pair";
  if (camera != camera_) return "the camera has changed";
  const double gap_s = seconds(pair.stamp_ns - stamp_ns_);
  if (gap_s <= config_.max_gap_s) return "";
  return sentence("no pair for ", gap_s, " s, more than max_gap_s = ", config_.max_gap_s);
}

void VisualOdometry::Pipeline::takePair(const StereoPair& pair,
                                        const StereoCamera& camera,
                                        StageTimes& times) {
  const StageTimer timer(times.pyramids_ms);
  if (camera != camera_) {
    calibrator_.reset();
    rows_.reset();
    noise_.reset();
  }
  calibrator_.advance();
  camera_ = camera;
  corrected_ = calibrator_.correct(camera);
  stamp_ns_ = pair.stamp_ns;
  finder_.take(pair, corrected_);
}

void VisualOdometry::Pipeline::startFromCurrent() {
  finder_.keep();
  has_last_ = true;
  last_stamp_ns_ = stamp_ns_;
  has_lost_ = false;
  keyframe_serves_ = false;
  motion_model_.reset();
}

/// Gives the last pair up for the one that was lost after it, whose pose is taken to be the same.
void VisualOdometry::Pipeline::takeUpLost(OdometryResult& result) {
  finder_.takeUpAside();
  last_stamp_ns_ = lost_stamp_ns_;
  has_lost_ = false;
  motion_model_.reset();
  result.dt_s = seconds(stamp_ns_ - last_stamp_ns_);
  makeKeyframeOfLast(result);
}

double VisualOdometry::Pipeline::sinceKeyframe_s() const {
  return seconds(stamp_ns_ - keyframe_stamp_ns_);
}

void VisualOdometry::Pipeline::makeKeyframeOfLast(OdometryResult& result) {
  finder_.refer();
  selector_.restart();
  keyframe_stamp_ns_ = last_stamp_ns_;
  T_keyframe_last_ = {};
  {
    const StageTimer timer(result.times.corners_ms);
    keyframe_corners_ = finder_.findCorners();
  }
  const StageTimer timer(result.times.disparity_ms);
  keyframe_with_depth_ = finder_.findDepths();
}

/// With a prediction one round is enough. Without one, or where it proves wrong, features tracked
/// from a wrong place may agree on a wrong motion: predict, track and estimate until it settles.
std::string VisualOdometry::Pipeline::findMotion(const std::optional<Eigen::Isometry3d>& T_last_cur,
                                                 OdometryResult& result) {
  if (T_last_cur) {
    trackAndEstimate(T_keyframe_last_.T * *T_last_cur, true, result);
    if (whyLost().empty()) {
      calibrate(result);
      return "";
    }
  }
  Eigen::Isometry3d T_keyframe_cur = T_keyframe_last_.T;
  for (int round = 0; round < config_.startup_rounds; ++round) {
    trackAndEstimate(T_keyframe_cur, false, result);
    if (!estimate_.valid) break;
    const double shift_px = finder_.medianShift(T_keyframe_cur, estimate_.T_prev_cur);
    T_keyframe_cur = estimate_.T_prev_cur;
    if (shift_px < config_.startup_settled_px) break;
  }
  std::string why_lost = whyLost();
  if (why_lost.empty()) calibrate(result);
  return why_lost;
}

std::string VisualOdometry::Pipeline::whyLost() const {
  return check_.whyLost(estimate_, sinceKeyframe_s());
}

void VisualOdometry::Pipeline::trackAndEstimate(const Eigen::Isometry3d& T_keyframe_cur,
                                                bool is_prediction,
                                                OdometryResult& result) {
  {
    const StageTimer timer(result.times.tracking_ms);
    result.counts.tracked = finder_.track(T_keyframe_cur, is_prediction);
    finder_.checkCircularConsistency(features_);
    result.counts.corners = keyframe_corners_;
    result.counts.with_depth = keyframe_with_depth_;
    result.counts.consistent = static_cast<int>(features_.size());
  }
  const StageTimer timer(result.times.estimation_ms);
  estimator_.setNoiseRatio(noise_.noise().ratio);
  estimate(T_keyframe_cur, is_prediction, result);
}

void VisualOdometry::Pipeline::estimate(const Eigen::Isometry3d& T_keyframe_cur,
                                        bool is_prediction,
                                        OdometryResult& result) {
  estimate_ =
      estimator_.estimate(corrected_, features_, T_keyframe_cur, sinceKeyframe_s(), is_prediction);
  result.counts.rotation_inliers = count(estimate_.rotation_inliers);
  result.counts.translation_inliers =
      estimate_.has_translation_stage ? count(estimate_.translation_inliers) : 0;
}

/// The features show the rig's bias as well as the motion: both are found in turns.
void VisualOdometry::Pipeline::calibrate(OdometryResult& result) {
  const StageTimer timer(result.times.estimation_ms);
  for (int round = 0; round < kCalibrationRounds; ++round) {
    calibrator_.observe(corrected_, features_, estimate_.rotation_inliers, estimate_.T_prev_cur);
    const StereoCamera corrected = calibrator_.correct(camera_);
    if (std::abs(corrected.cx_right - corrected_.cx_right) < kCalibrationSettled_px) return;
    const StereoCamera camera_before = corrected_;
    estimate_before_ = estimate_;
    corrected_ = corrected;
    triangulate(corrected_, features_);
    estimate(estimate_.T_prev_cur, true, result);
    if (whyLost().empty()) continue;
    corrected_ = camera_before;
    estimate_ = estimate_before_;
    triangulate(corrected_, features_);
    return;
  }
}

void VisualOdometry::Pipeline::accept(OdometryResult& result) {
  noise_.observe(corrected_, features_, estimate_.rotation_inliers, estimate_.T_prev_cur);
  finder_.compareRows(features_, estimate_.rotation_inliers, row_differences_px_);
  rows_.observe(row_differences_px_);
  result.keyframe_stamp_ns = keyframe_stamp_ns_;
  result.T_keyframe_cur = {estimate_.T_prev_cur,
                           estimate_.covariance + calibrator_.motionCovariance()};
  UncertainTransform step = compose(inverse(T_keyframe_last_), result.T_keyframe_cur);
  if (keyframe_stamp_ns_ != last_stamp_ns_) step.covariance *= kNotShared;
  result.T_prev_cur = step.T;
  result.covariance = step.covariance;
  result.reason = check_.whyDegraded(estimate_);
  if (const auto expected = motion_model_.predict(result.dt_s); expected && result.reason.empty()) {
    result.reason = check_.whyJump(step, *expected, result.dt_s);
  }
  result.state = result.reason.empty() ? State::kOk : State::kDegraded;
  motion_model_.update(step.T, result.dt_s);

  T_keyframe_last_ = result.T_keyframe_cur;
  finder_.keep();
  last_stamp_ns_ = stamp_ns_;
  has_lost_ = false;
  keyframe_serves_ =
      result.state == State::kOk &&
      selector_.keeps(corrected_, features_, estimate_.rotation_inliers, estimate_.T_prev_cur);
}

void VisualOdometry::Pipeline::giveUp(const std::string& why, OdometryResult& result) {
  result.state = State::kLost;
  result.reason = why;
}

void VisualOdometry::Pipeline::forgetFeatures() {
  features_.clear();
  estimate_.rotation_inliers.clear();
  estimate_.translation_inliers.clear();
}

}  // namespace rotrocc
