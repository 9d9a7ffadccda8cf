#include "odometry/odometry_pipeline.h"

#include <stdexcept>
#include <utility>

#include "common/sentence.h"
#include "common/stage_timer.h"
#include "common/to_seconds.h"
#include "odometry/pair_check.h"
#include "odometry/systematic_error.h"

namespace rotrocc {
namespace {

/// Part of the covariance that two motions from the same keyframe do not share: the noise of the
/// keyframe's corners is common to both, and is half of the flow's noise.
constexpr double kNotShared = 0.5;

/// Ends the processing of a pair without a motion. what() is the reason, as a sentence.
struct Lost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace

VisualOdometry::Pipeline::Pipeline(const Config& config)
    : config_(config),
      finder_(config.correspondence_finder, config.threads),
      motion_model_(config.motion_model),
      search_(config),
      check_(config.motion_check, config.motion_estimator.noise_ratio),
      selector_(config.keyframe_selector),
      rig_(config) {}

OdometryResult VisualOdometry::Pipeline::process(const StereoPair& pair,
                                                 const StereoCamera& camera,
                                                 const OtherSensors& others) {
  OdometryResult result;
  result.stamp_ns = pair.stamp_ns;
  result.times = std::exchange(prepared_, {});
  result.times.prepared_ms = std::exchange(result.times.total_ms, 0.0);
  found_.clear();
  const StageTimer timer(result.times.total_ms);
  try {
    advance(pair, camera, others, result);
  } catch (const Lost& lost) {
    result.reason = lost.what();
  } catch (const std::exception& error) {
    forget();  // the stored state may be the cause
    result.reason = sentence("internal error: ", error.what());
    result.state = State::kLost;
  }
  result.counts = found_.counts;
  rig_.report(result);
  if (result.hasMotion()) {
    result.disparity_bias.applied_px = found_.camera.cx_right - camera.cx_right;
    result.row_offset.applied_px = keyframe_.row_offset_px;
  }
  return result;
}

void VisualOdometry::Pipeline::prepare() {
  // Until the rows are known, each keyframe adds to what is known of them. Not all keyframes that
  // are prepared are used.
  if (!last_ || keyframe_.frame || !rig_.knowsRows()) return;
  const StageTimer timer(prepared_.total_ms);
  try {
    makeKeyframe(last_, prepared_);
  } catch (const std::exception&) {
    keyframe_.frame.reset();  // process() tries again, and reports it
  }
}

void VisualOdometry::Pipeline::reset() {
  forget();
  found_.clear();
}

/// Restarts with the next pair.
void VisualOdometry::Pipeline::forget() {
  last_.reset();
  lost_.reset();
  keyframe_.frame.reset();
  motion_model_.reset();
  search_.reset();
}

void VisualOdometry::Pipeline::configure(const Config& config) {
  search_ = MotionSearch(config);  // first, because it may throw
  config_ = config;
  finder_ = CorrespondenceFinder(config.correspondence_finder, config.threads);
  motion_model_.configure(config.motion_model);
  check_ = MotionCheck(config.motion_check, config.motion_estimator.noise_ratio);
  selector_ = KeyframeSelector(config.keyframe_selector);
  rig_.configure(config);
  keyframe_.frame.reset();  // its corners depend on the old parameters
}

void VisualOdometry::Pipeline::advance(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const OtherSensors& others,
                                       OdometryResult& result) {
  const auto newest_ns = last_ ? std::optional(newest().stamp_ns) : std::nullopt;
  const std::string why_unusable = whyUnusable(pair, camera, newest_ns);
  if (!why_unusable.empty()) throw Lost(why_unusable);
  result.reason = whyRestart(pair, camera);
  const FramePtr current = takeFrame(pair, camera, result.times);
  if (!result.reason.empty()) {
    forget();
    last_ = current;
    // Now, as nobody waits for a motion.
    makeKeyframe(last_, result.times);
    result.state = State::kInitialising;
    return;
  }
  findMotion(current, others, result);
  if (!found_.isAccepted()) {
    // Either this pair or the last one may be at fault. The next pair is compared with both.
    lost_ = current;
    rig_.searchRowsAgain();
    throw Lost(found_.why_lost);
  }
  accept(current, result);
}

/// Why the pair cannot be compared with an earlier one; empty if it can.
std::string VisualOdometry::Pipeline::whyRestart(const StereoPair& pair,
                                                 const StereoCamera& camera) const {
  if (!last_) return "first pair";
  if (camera != rig_.camera()) return "the camera has changed";
  const double gap_s = toSeconds(pair.stamp_ns - newest().stamp_ns);
  if (gap_s <= config_.max_gap_s) return "";
  return sentence("no pair for ", gap_s, " s, more than max_gap_s = ", config_.max_gap_s);
}

FramePtr VisualOdometry::Pipeline::takeFrame(const StereoPair& pair,
                                             const StereoCamera& camera,
                                             StageTimes& times) {
  const StageTimer timer(times.pyramids_ms);
  rig_.setCamera(camera);
  return finder_.makeFrame(pair);
}

void VisualOdometry::Pipeline::makeKeyframe(const FramePtr& frame, StageTimes& times) {
  keyframe_.frame = frame;
  keyframe_.T_keyframe_last = {};
  keyframe_.first_inlier_share = 0.0;
  {
    const StageTimer timer(times.corners_ms);
    finder_.findCorners(keyframe_);
  }
  const StageTimer timer(times.disparity_ms);
  rig_.startKeyframe(keyframe_);
  finder_.findDepths(rig_.correctedCamera(), keyframe_);
}

/// The expected motion since the last frame. Without a velocity, a measured rotation is all that is
/// known of it.
MotionSearch::Expectation VisualOdometry::Pipeline::expectation(const StereoFrame& current,
                                                                const OtherSensors& others) const {
  MotionSearch::Expectation expected;
  if (others.rotation) expected.R_last_cur = others.rotation(last_->stamp_ns, current.stamp_ns);
  expected.T_last_cur = others.T_last_cur ? others.T_last_cur
                                          : motion_model_.predict(secondsBetween(*last_, current),
                                                                  expected.R_last_cur);
  if (expected.T_last_cur && expected.R_last_cur) {
    expected.T_last_cur->linear() = *expected.R_last_cur;
  }
  return expected;
}

/// Measures the motion against the keyframe. If that fails, uses the last frame, then the latest
/// lost frame, which is assigned the pose of the last frame. The total number of tries is limited,
/// so that no pair takes much longer than one without a prediction.
void VisualOdometry::Pipeline::findMotion(const FramePtr& current,
                                          const OtherSensors& others,
                                          OdometryResult& result) {
  result.dt_s = secondsBetween(*last_, *current);
  MotionSearch::Expectation expected = expectation(*current, others);
  const StereoCamera corrected = rig_.correctedCamera();
  const auto find = [&](int most_tries) {
    const MotionSearch::Frames frames = {
        finder_, corrected, keyframe_, *current, rig_.sharedRatio()};
    search_.find(frames, expected, most_tries, found_, result.times);
  };
  if (!keyframe_.frame) makeKeyframe(last_, result.times);
  const int most = config_.max_tries;
  const bool has_other = keyframe_.frame != last_ || lost_;
  find(has_other ? most - 1 : most);
  expected.T_last_cur.reset();  // has failed, if another find() is needed
  if (!found_.isAccepted() && keyframe_.frame != last_) {
    makeKeyframe(last_, result.times);
    find(most);
  }
  if (!found_.isAccepted() && lost_) {
    last_ = std::move(lost_);
    lost_.reset();
    motion_model_.reset();
    result.dt_s = secondsBetween(*last_, *current);
    expected = expectation(*current, {std::nullopt, others.rotation});
    makeKeyframe(last_, result.times);
    find(most);
  }
  if (!found_.isAccepted()) return;
  const double dt_s = secondsBetween(*keyframe_.frame, *current);
  search_.calibrate(rig_.camera(), dt_s, rig_.calibrator(), found_, result.times);
}

void VisualOdometry::Pipeline::accept(const FramePtr& current, OdometryResult& result) {
  const MotionEstimator::Estimate& estimate = found_.estimate;
  rig_.observe(found_, keyframe_, *current);

  result.exposure_gain = found_.exposure_gain;
  result.shared_error_ratio = found_.shared_ratio;
  result.flow_noise_px = estimate.flow_noise_px;
  result.keyframe_stamp_ns = keyframe_.frame->stamp_ns;
  result.T_keyframe_cur = {estimate.T_keyframe_cur, estimate.covariance + rig_.motionCovariance()};
  UncertainTransform step = compose(inverse(keyframe_.T_keyframe_last), result.T_keyframe_cur);
  if (keyframe_.frame != last_) step.covariance *= kNotShared;
  result.T_prev_cur = step.T;
  result.covariance = step.covariance + systematicCovariance(config_.systematic_error, step.T);
  result.reason = check_.whyDegraded(found_, result.T_keyframe_cur.covariance);
  if (const auto expected = motion_model_.predict(result.dt_s); expected && result.reason.empty()) {
    result.reason = check_.whyJump(step, *expected, result.dt_s);
  }
  result.state = result.reason.empty() ? State::kOk : State::kDegraded;
  motion_model_.update(step.T, result.dt_s);

  last_ = current;
  lost_.reset();
  keyframe_.T_keyframe_last = result.T_keyframe_cur;
  const bool serves = result.state == State::kOk && check_.hasReserve(estimate) &&
                      selector_.keeps(found_, keyframe_);
  if (!serves) keyframe_.frame.reset();
}

}  // namespace rotrocc
