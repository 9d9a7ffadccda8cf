#include "rotrocc/visual_odometry.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "common/stage_timer.h"
#include "common/to_seconds.h"
#include "features/base_level.h"
#include "features/correspondence_finder.h"
#include "odometry/motion_check.h"
#include "odometry/motion_search.h"
#include "odometry/pair_checks.h"
#include "odometry/rig_estimate.h"
#include "paper/paper_finder.h"

namespace rotrocc {
namespace {

/// Part of the covariance that two motions from the same keyframe do not share: the noise of the
/// keyframe's corners is common to both, and is half of the flow's noise.
constexpr double kNotShared = 0.5;

/// After so many periods of the pairs, the velocity may have changed so much that rest is as good a
/// start as what the last motion predicts.
constexpr double kPredictable = 5.0;

/// Weight of the last interval in the period of the pairs.
constexpr double kNewInterval = 0.1;

std::unique_ptr<CorrespondenceFinder> makeFinder(const OdometryConfig& config) {
  if (config.isPaper()) return std::make_unique<PaperFinder>(config.correspondence_finder);
  return std::make_unique<CorrespondenceFinder>(config.correspondence_finder);
}

/// Without a motion.
OdometryResult resultOf(const StereoPair& pair) {
  OdometryResult result;
  result.stamp_ns = result.prev_stamp_ns = pair.stamp_ns;
  result.clock_set_ns = result.prev_clock_set_ns = pair.clock_set_ns;
  result.stamp_sigma_s = pair.stamp_sigma_s;
  return result;
}

void setPrevious(const StereoFrame& frame, OdometryResult& result) {
  result.prev_stamp_ns = frame.stamp_ns;
  result.prev_clock_set_ns = frame.clock_set_ns;
}

/// Not if the clock of the images was set in between: that of the other sensor was not.
std::optional<Eigen::Matrix3d> measuredRotation(const StereoFrame& from,
                                                const StereoFrame& to,
                                                const RotationSource& source) {
  if (!source || from.clock_set_ns != to.clock_set_ns) return std::nullopt;
  return source(from.stamp_ns, to.stamp_ns);
}

/// Ends the processing of a pair without a motion. what() is the reason, as a sentence.
struct Lost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace

/// The state between pairs, and the processing stages in the order of section V.
class VisualOdometry::Pipeline {
 public:
  explicit Pipeline(const Config& config);

  /// What other sensors know of the motion, see VisualOdometry::process().
  struct OtherSensors {
    const std::optional<Eigen::Isometry3d>& T_last_cur;
    const RotationSource& rotation;
    const std::function<bool()>& may_repeat;
  };

  OdometryResult process(const StereoPair& pair,
                         const StereoCamera& camera,
                         const OtherSensors& others);
  void prepare();
  void reset();
  void configure(const Config& config);

  const Hypothesis& found() const { return found_; }

 private:
  /// Throws Lost if there is no motion.
  void advance(const StereoPair& pair,
               const StereoCamera& camera,
               const OtherSensors& others,
               OdometryResult& result);
  void fail();
  void forget();
  void useLevel(const StereoPair& pair, const FramePtr& current);
  void report(const StereoCamera& camera, OdometryResult& result);
  void makeKeyframe(const FramePtr& frame, StageTimes& times);

  /// What is known of the motion from the last frame, or the lost one, to the current frame.
  struct Expectation {
    double dt_s;
    std::optional<Eigen::Matrix3d> R_last_cur;    ///< as another sensor measured it
    std::optional<Eigen::Isometry3d> T_last_cur;  ///< as predicted
  };
  Expectation expectation(const StereoFrame& current, const OtherSensors& others) const;
  std::optional<Eigen::Isometry3d> predict(double dt_s) const;
  void findMotion(const FramePtr& current, const OtherSensors& others, OdometryResult& result);
  bool findMotionFrom(const FramePtr& earlier,
                      const StereoFrame& current,
                      const Expectation& expected,
                      StageTimes& times);
  void accept(const FramePtr& current, OdometryResult& result);

  Config config_;
  std::unique_ptr<CorrespondenceFinder> finder_;
  MotionSearch search_;
  MotionCheck check_;
  RigEstimate rig_;
  BaseLevel base_;
  int level_ = 0;  // of the stored frames, and of what is measured

  FramePtr last_;                     // last frame with a known pose; null before the first pair
  FramePtr lost_;                     // latest frame without a motion since last_; may be null
  std::optional<Vector6d> velocity_;  // [m/s; rad/s] of the last motion
  double period_s_ = 0.0;             // mean interval of the last pairs; 0 before the second one
  Keyframe keyframe_;                 // no frame if it must be created from the last frame
  bool is_after_loss_ = false;        // the last pair had no motion
  bool has_failed_ = false;           // an error of a library has ended the last pair

  StageTimes prepared_;  // of prepare() since the last pair
  Hypothesis found_;
};

VisualOdometry::Pipeline::Pipeline(const Config& config)
    : config_(config),
      finder_(makeFinder(config_)),
      search_(config_),
      check_(config_.motion_check, config_.isPaper()),
      rig_(config_),
      base_(config_.correspondence_finder.feature_detector) {}

OdometryResult VisualOdometry::Pipeline::process(const StereoPair& pair,
                                                 const StereoCamera& camera,
                                                 const OtherSensors& others) {
  OdometryResult result = resultOf(pair);
  result.times = std::exchange(prepared_, {});
  result.times.prepared_ms = std::exchange(result.times.total_ms, 0.0);
  found_.clear();
  const StageTimer timer(result.times.total_ms);
  try {
    advance(pair, camera, others, result);
    has_failed_ = false;
  } catch (const Lost& lost) {
    has_failed_ = false;
    is_after_loss_ = last_ != nullptr;
    result.reason = lost.what();
  } catch (const std::exception& error) {
    fail();
    result = resultOf(pair);
    result.reason = std::string("internal error: ") + error.what();
  }
  report(camera, result);
  return result;
}

/// Stores what was found, in pixels of whole images.
void VisualOdometry::Pipeline::report(const StereoCamera& camera, OdometryResult& result) {
  const double px = std::exp2(level_);
  result.halvings = level_;
  result.counts = found_.counts;
  rig_.report(result);
  if (result.hasMotion()) {
    result.disparity_bias.applied_px = px * found_.camera.cx_right - camera.cx_right;
    result.row_offset.applied_px = px * keyframe_.row_offset_px;
    result.right_delay.applied_s = keyframe_.right_delay_s;
  }
  result.flow_noise_px *= px;
  if (level_ == 0) return;
  for (Correspondence& feature : found_.features) {
    feature.keyframe_px *= px;
    feature.cur_px *= px;
    feature.disparity_px *= px;
  }
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

/// After a library's error, the next pair is compared with the last one again. After a second error
/// in a row, the stored state may be the cause.
void VisualOdometry::Pipeline::fail() {
  if (std::exchange(has_failed_, true)) forget();
  lost_.reset();
  keyframe_.frame.reset();
}

/// Restarts with the next pair.
void VisualOdometry::Pipeline::forget() {
  last_.reset();
  lost_.reset();
  is_after_loss_ = false;
  keyframe_.frame.reset();
  velocity_.reset();
  period_s_ = 0.0;
  base_.observeSurvivors(0.0);
}

void VisualOdometry::Pipeline::configure(const Config& config) {
  // First, because they may throw.
  auto finder = makeFinder(config);
  MotionSearch search(config);
  config_ = config;
  base_.configure(config_.correspondence_finder.feature_detector);
  if (config_.isPaper()) base_.reset();
  finder_ = std::move(finder);
  search_ = std::move(search);
  check_ = MotionCheck(config_.motion_check, config_.isPaper());
  rig_.configure(config_);
  keyframe_.frame.reset();  // its corners depend on the old parameters
}

void VisualOdometry::Pipeline::advance(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const OtherSensors& others,
                                       OdometryResult& result) {
  if (const auto why = whyUnusable(pair, camera)) throw Lost(*why);
  const StereoFrame* newest = lost_ ? lost_.get() : last_.get();
  const bool is_later = newest == nullptr || pair.time_ns() > newest->time_ns();
  const auto why_restart = whyRestart(pair, camera, newest, rig_.camera(), period_s_);
  if (!why_restart && !is_later) {
    throw Lost("the stamp " + std::to_string(pair.stamp_ns) +
               " ns is not later than that of the previous pair, " +
               std::to_string(newest->stamp_ns) + " ns");
  }
  FramePtr current;
  {
    const StageTimer timer(result.times.pyramids_ms);
    current = finder_->makeFrame(pair, base_.level());
    if (newest != nullptr && is_later) {
      const auto why = whyRepeated(pair, *current, *newest, others.may_repeat);
      if (why) throw Lost(*why);
    }
    if (why_restart) forget();
    if (!rig_.setCamera(camera)) {
      keyframe_.frame.reset();  // its depths are of the old calibration
      base_.reset();
    }
    useLevel(pair, current);
  }
  if (why_restart) {
    result.reason = *why_restart;
    last_ = current;
    // Now, as nobody waits for a motion.
    makeKeyframe(last_, result.times);
    result.state = State::kInitializing;
    return;
  }
  const double interval_s = toSeconds(pair.time_ns() - newest->time_ns());
  findMotion(current, others, result);
  if (found_.isAccepted()) accept(current, result);
  period_s_ += (period_s_ == 0.0 ? 1.0 : kNewInterval) * (interval_s - period_s_);
  if (found_.isAccepted()) return;
  // Either this pair or the last one may be at fault. The next pair is compared with both.
  lost_ = current;
  keyframe_.frame.reset();  // the next one has more features
  base_.observeSurvivors(0.0);
  rig_.searchRowsAgain();
  throw Lost(*found_.why_lost);
}

/// Continues at the base level, or at the first one that all stored frames have.
void VisualOdometry::Pipeline::useLevel(const StereoPair& pair, const FramePtr& current) {
  if (!config_.isPaper()) base_.observe(pair.left, current->whole_left);
  int level = base_.level();
  for (const FramePtr& frame : {current, last_, lost_}) {
    if (frame && !frame->hasImage()) level = std::max(level, 1);
  }
  if (level != level_) keyframe_.frame.reset();
  level_ = level;
  for (const FramePtr& frame : {current, last_, lost_}) {
    if (frame) frame->setLevel(level_);
  }
  rig_.setLevel(level_, base_.detail_px(), base_.window_scale());
}

void VisualOdometry::Pipeline::makeKeyframe(const FramePtr& frame, StageTimes& times) {
  keyframe_.frame = frame;
  keyframe_.T_keyframe_last = {};
  const StereoCamera camera = rig_.correctedCamera();
  {
    const StageTimer timer(times.corners_ms);
    finder_->findCorners(keyframe_);
  }
  const StageTimer timer(times.disparity_ms);
  rig_.startKeyframe(keyframe_);
  finder_->findDepths(camera, base_.wantedFeatures(), keyframe_);
}

VisualOdometry::Pipeline::Expectation VisualOdometry::Pipeline::expectation(
    const StereoFrame& current, const OtherSensors& others) const {
  Expectation expected = {secondsBetween(*last_, current), std::nullopt, others.T_last_cur};
  expected.R_last_cur = measuredRotation(*last_, current, others.rotation);
  if (!expected.T_last_cur) expected.T_last_cur = predict(expected.dt_s);
  if (expected.T_last_cur && expected.R_last_cur) {
    expected.T_last_cur->linear() = *expected.R_last_cur;
  }
  return expected;
}

/// The motion by the constant velocity of the last one, unless that is too long ago. The velocity
/// turns with the camera, as with a vehicle: it keeps its direction in the camera's axes.
std::optional<Eigen::Isometry3d> VisualOdometry::Pipeline::predict(double dt_s) const {
  if (!velocity_ || dt_s > kPredictable * period_s_) return std::nullopt;
  return expMotion(*velocity_ * dt_s);
}

/// Measures the motion against the keyframe. If that fails, against the last frame, then against
/// the latest lost frame: if that fits, it is assigned the pose of the last frame, which it
/// replaces, and the way between both is missing.
void VisualOdometry::Pipeline::findMotion(const FramePtr& current,
                                          const OtherSensors& others,
                                          OdometryResult& result) {
  const Expectation expected = expectation(*current, others);
  setPrevious(*last_, result);
  const FramePtr keyframe = keyframe_.frame;
  if (keyframe && keyframe != last_ && findMotionFrom(keyframe, *current, expected, result.times) &&
      !check_.whyNotAtRest(found_)) {
    return;
  }
  if (findMotionFrom(last_, *current, expected, result.times) || !lost_) return;
  // It has no pose of its own, so nothing predicts the motion from there.
  Expectation of_lost = {secondsBetween(*lost_, *current), std::nullopt, std::nullopt};
  of_lost.R_last_cur = measuredRotation(*lost_, *current, others.rotation);
  if (findMotionFrom(lost_, *current, of_lost, result.times)) {
    result.reason = cv::format("only the lost pair %.3g s earlier matches: ", of_lost.dt_s) +
                    cv::format("the distance of the %.3g s before that is missing",
                               secondsBetween(*last_, *lost_));
    setPrevious(*lost_, result);
    last_ = std::move(lost_);
    velocity_.reset();
  }
}

/// Makes `earlier` the keyframe, unless it is, and tries one start after the other until a motion
/// is accepted: the predicted motion; rest, or the measured rotation; where the scene is
/// recognized. An older keyframe gets no recognition, because more is seen of the last frame. The
/// number of tries from each frame is limited, so that no pair takes much longer than others.
bool VisualOdometry::Pipeline::findMotionFrom(const FramePtr& earlier,
                                              const StereoFrame& current,
                                              const Expectation& expected,
                                              StageTimes& times) {
  using Start = MotionSearch::Start;
  if (keyframe_.frame != earlier) makeKeyframe(earlier, times);
  const StereoCamera corrected = rig_.correctedCamera();
  const MotionSearch::Frames frames = {
      *finder_, corrected, keyframe_, current, expected.dt_s, times};
  const auto converges = [&](const std::optional<Start>& start) {
    return start && search_.find(frames, *start, found_);
  };
  const Eigen::Isometry3d& T_keyframe_last = keyframe_.T_keyframe_last.T;
  std::optional<Start> predicted;
  if (expected.T_last_cur) predicted = {T_keyframe_last * *expected.T_last_cur, true};
  Start at_rest = {T_keyframe_last, false};
  if (expected.R_last_cur) at_rest.T_keyframe_cur.rotate(*expected.R_last_cur);
  const bool is_newest = earlier == last_ || earlier == lost_;

  const int tries = found_.counts.tries;  // from other frames
  found_.clear();
  if (!converges(predicted) && !converges(at_rest) && is_newest &&
      found_.counts.tries < config_.max_tries) {
    converges(search_.recognize(frames));
  }
  found_.counts.tries += tries;
  if (!found_.isAccepted()) return false;
  search_.calibrate(frames, rig_, found_);
  return true;
}

void VisualOdometry::Pipeline::accept(const FramePtr& current, OdometryResult& result) {
  const MotionEstimate& estimate = found_.estimate;
  const StageCounts& counts = found_.counts;
  base_.observeSurvivors(static_cast<double>(counts.rotation_inliers) / counts.with_depth);
  result.contrast_gain = found_.contrast_gain;
  result.flow_noise_px = estimate.flow_noise_px;
  result.keyframe_stamp_ns = keyframe_.frame->stamp_ns;
  const Matrix6d of_rig = rig_.motionCovariance();
  const double inflation = MotionCheck::inflation(estimate, config_.systematic_error.common_share);
  result.T_keyframe_cur = {estimate.T_keyframe_cur, inflation * estimate.covariance + of_rig};
  UncertainTransform step = compose(inverse(keyframe_.T_keyframe_last), result.T_keyframe_cur);
  if (keyframe_.frame != last_) step.covariance *= kNotShared;
  result.T_prev_cur = step.T;
  result.covariance = step.covariance + config_.systematic_error.covarianceOf(step.T);
  auto why_degraded = check_.whyDegraded(found_, estimate.covariance + of_rig);
  if (const auto expected = predict(result.dt_s()); expected && !why_degraded) {
    why_degraded = MotionCheck::whyJump(step, *expected, result.dt_s());
  }
  rig_.observeRows(found_, keyframe_, *current, why_degraded.has_value());
  if (why_degraded && result.reason.empty()) result.reason = *why_degraded;
  // A driver that repeats images loses single pairs.
  const bool is_long = result.dt_s() > kPredictable * period_s_;
  if (std::exchange(is_after_loss_, false) && is_long && result.reason.empty()) {
    result.reason =
        cv::format("measured from the pair %.3g s earlier, across lost pairs", result.dt_s());
  }
  result.state = result.reason.empty() ? State::kOk : State::kDegraded;
  velocity_ = logMotion(step.T) / result.dt_s();

  last_ = current;
  lost_.reset();
  keyframe_.T_keyframe_last = result.T_keyframe_cur;
  // Noise accumulates with each new keyframe, so one is kept while the camera rests: there is no
  // drift at standstill. In motion each frame is the keyframe of the next one, because the errors
  // of a feature grow with the way that it is tracked.
  const bool serves =
      result.state == State::kOk && !config_.isPaper() && MotionCheck::isAtRest(found_);
  if (!serves) keyframe_.frame.reset();
}

const char* toString(State state) {
  static const char* const kNames[] = {"initializing", "ok", "degraded", "lost"};
  return kNames[static_cast<int>(state)];
}

VisualOdometry::VisualOdometry(const Config& config)
    : pipeline_(std::make_unique<Pipeline>(config)) {}
VisualOdometry::~VisualOdometry() = default;
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;

OdometryResult VisualOdometry::process(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const std::optional<Eigen::Isometry3d>& expected,
                                       const RotationSource& measured_rotation,
                                       const std::function<bool()>& may_repeat) {
  return pipeline_->process(pair, camera, {expected, measured_rotation, may_repeat});
}

void VisualOdometry::prepare() {
  pipeline_->prepare();
}

void VisualOdometry::reset() {
  pipeline_->reset();
}

void VisualOdometry::configure(const Config& config) {
  pipeline_->configure(config);
}

const Correspondences& VisualOdometry::correspondences() const {
  return pipeline_->found().features;
}
const FeatureSet& VisualOdometry::rotationInliers() const {
  return pipeline_->found().estimate.rotation_inliers;
}
const FeatureSet& VisualOdometry::translationInliers() const {
  return pipeline_->found().estimate.translation_inliers;
}

}  // namespace rotrocc
