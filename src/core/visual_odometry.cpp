#include "rotrocc/visual_odometry.h"

#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "rotrocc/outlier_rejection.h"

namespace rotrocc {
namespace {

/// Adds the time until it goes out of scope to a stage's account.
class StageTimer {
 public:
  explicit StageTimer(double& account_ms) : account_ms_(account_ms) {}
  ~StageTimer() {
    account_ms_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& account_ms_;
  Clock::time_point start_ = Clock::now();
};

/// Ends the work on a pair without a motion; what() is the reason, a sentence.
struct Lost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// The bias and the motion are estimated in turns, so often at most, until the bias that is applied
/// changes by less than this.
constexpr int kCalibrationRounds = 3;
constexpr double kCalibrationSettled_px = 0.02;

void checkImage(const char* side, const cv::Mat& image, const StereoCamera& camera) {
  if (image.empty()) throw Lost(sentence("the ", side, " image is empty"));
  if (image.type() != CV_8UC1) {
    throw Lost(sentence("the ", side, " image is of OpenCV type ", image.type(), ", not CV_8UC1"));
  }
  if (image.cols != camera.width || image.rows != camera.height) {
    throw Lost(sentence("the ",
                        side,
                        " image has ",
                        image.cols,
                        "x",
                        image.rows,
                        " pixels, the camera ",
                        camera.width,
                        "x",
                        camera.height));
  }
}

}  // namespace

const char* toString(State state) {
  switch (state) {
    case State::kInitialising:
      return "initialising";
    case State::kOk:
      return "ok";
    case State::kDegraded:
      return "degraded";
    case State::kLost:
      return "lost";
  }
  return "unknown";
}

/// What is kept from pair to pair, and the stages in the order of section V.
class VisualOdometry::Pipeline {
 public:
  explicit Pipeline(const Config& config)
      : config_(config),
        finder_(config.correspondence_finder),
        motion_model_(config.motion_model),
        estimator_(config.motion_estimator),
        check_(config.motion_check),
        calibrator_(config.stereo_calibrator, config.motion_estimator.noise_ratio) {}

  OdometryResult process(const StereoPair& pair,
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
      giveUp(sentence("internal error: ", error.what()), result);
    }
    return result;
  }

  void reset() {
    has_previous_ = false;
    motion_model_.reset();
    forgetFeatures();
  }

  const Correspondences& correspondences() const { return features_; }
  const FeatureSet& rotationInliers() const { return estimate_.rotation_inliers; }
  const FeatureSet& translationInliers() const { return estimate_.translation_inliers; }

 private:
  void advance(const StereoPair& pair,
               const StereoCamera& camera,
               const std::optional<Eigen::Isometry3d>& expected,
               OdometryResult& result) {
    checkInput(pair, camera);
    const std::string why_start = whyStart(pair, camera);
    const std::int64_t previous_stamp_ns = stamp_ns_;
    takePair(pair, camera, result.times);
    result.disparity_bias = calibrator_.bias();
    if (!why_start.empty()) {
      motion_model_.reset();
      result.state = State::kInitialising;
      result.reason = why_start;
      return;
    }
    result.dt_s = seconds(stamp_ns_ - previous_stamp_ns);
    findCorners(result);
    findDepths(result);
    findMotion(expected ? expected : motion_model_.predict(result.dt_s), result);
    motion_model_.update(result.T_prev_cur, result.dt_s);
  }

  void checkInput(const StereoPair& pair, const StereoCamera& camera) const {
    camera.check();
    checkImage("left", pair.left, camera);
    checkImage("right", pair.right, camera);
    if (has_previous_ && pair.stamp_ns <= stamp_ns_) {
      throw Lost(sentence("the stamp ",
                          pair.stamp_ns,
                          " ns is not later than that of the pair before, ",
                          stamp_ns_,
                          " ns"));
    }
  }

  /// Why the pair cannot be compared with the one before; empty if it can.
  std::string whyStart(const StereoPair& pair, const StereoCamera& camera) const {
    if (!has_previous_) return "first pair";
    if (camera != camera_) return "the camera has changed";
    const double gap_s = seconds(pair.stamp_ns - stamp_ns_);
    if (gap_s <= config_.max_gap_s) return "";
    return sentence("no pair for ", gap_s, " s, more than max_gap_s = ", config_.max_gap_s);
  }

  void takePair(const StereoPair& pair, const StereoCamera& camera, StageTimes& times) {
    const StageTimer timer(times.pyramids_ms);
    has_previous_ = false;  // in case it throws
    if (camera != camera_) calibrator_.reset();
    calibrator_.advance();
    corrected_ = calibrator_.correct(camera);
    finder_.advance(pair, corrected_);
    stamp_ns_ = pair.stamp_ns;
    camera_ = camera;
    has_previous_ = true;
  }

  void findCorners(OdometryResult& result) {
    const StageTimer timer(result.times.corners_ms);
    result.counts.corners = finder_.findCorners();
  }

  void findDepths(OdometryResult& result) {
    const StageTimer timer(result.times.disparity_ms);
    result.counts.with_depth = finder_.findDepths();
  }

  /// With a prediction one round is enough. Without one, or where it proves wrong, features tracked
  /// from a wrong place may agree on a wrong motion: predict, track and estimate until it settles.
  void findMotion(const std::optional<Eigen::Isometry3d>& predicted, OdometryResult& result) {
    const FeatureTracker::Config& tracker = config_.correspondence_finder.feature_tracker;
    if (predicted) {
      trackAndEstimate(*predicted, tracker.levels, result);
      if (check_.whyLost(estimate_, result.dt_s).empty()) {
        calibrate(result);
        return accept(result);
      }
    }
    Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
    for (int round = 0; round < config_.startup_rounds; ++round) {
      trackAndEstimate(T_prev_cur, tracker.startup_levels, result);
      if (!estimate_.valid) break;
      const double shift_px = finder_.medianShift(T_prev_cur, estimate_.T_prev_cur);
      T_prev_cur = estimate_.T_prev_cur;
      if (shift_px < config_.startup_settled_px) break;
    }
    const std::string why_lost = check_.whyLost(estimate_, result.dt_s);
    if (!why_lost.empty()) throw Lost(why_lost);
    calibrate(result);
    accept(result);
  }

  void trackAndEstimate(const Eigen::Isometry3d& predicted, int levels, OdometryResult& result) {
    {
      const StageTimer timer(result.times.tracking_ms);
      result.counts.tracked = finder_.track(predicted, levels);
      finder_.closeCircle(features_);
      result.counts.consistent = static_cast<int>(features_.size());
    }
    const StageTimer timer(result.times.estimation_ms);
    estimate(predicted, result);
  }

  void estimate(const Eigen::Isometry3d& initial, OdometryResult& result) {
    estimate_ = estimator_.estimate(corrected_, features_, initial, result.dt_s);
    result.counts.rotation_inliers = count(estimate_.rotation_inliers);
    result.counts.translation_inliers =
        estimate_.has_translation_stage ? count(estimate_.translation_inliers) : 0;
  }

  /// The features show the rig's bias as well as the motion: both are found in turns.
  void calibrate(OdometryResult& result) {
    const StageTimer timer(result.times.estimation_ms);
    for (int round = 0; round < kCalibrationRounds; ++round) {
      calibrator_.observe(corrected_, features_, estimate_.rotation_inliers, estimate_.T_prev_cur);
      const StereoCamera corrected = calibrator_.correct(camera_);
      if (std::abs(corrected.cx_right - corrected_.cx_right) < kCalibrationSettled_px) return;
      const MotionEstimator::Estimate before = estimate_;
      corrected_ = corrected;
      triangulate(corrected_, features_);
      estimate(estimate_.T_prev_cur, result);
      if (!check_.whyLost(estimate_, result.dt_s).empty()) {
        estimate_ = before;
        return;
      }
    }
  }

  void accept(OdometryResult& result) const {
    result.disparity_bias = calibrator_.bias();
    result.T_prev_cur = estimate_.T_prev_cur;
    result.covariance = estimate_.covariance;
    result.reason = check_.whyDegraded(estimate_);
    result.state = result.reason.empty() ? State::kOk : State::kDegraded;
  }

  void giveUp(const std::string& why, OdometryResult& result) {
    motion_model_.reset();
    result.state = State::kLost;
    result.reason = why;
  }

  void forgetFeatures() {
    features_.clear();
    estimate_.rotation_inliers.clear();
    estimate_.translation_inliers.clear();
  }

  static double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

  Config config_;
  CorrespondenceFinder finder_;
  MotionModel motion_model_;
  MotionEstimator estimator_;
  MotionCheck check_;

  bool has_previous_ = false;
  std::int64_t stamp_ns_ = 0;  // of the last pair taken
  StereoCamera camera_, corrected_;
  StereoCalibrator calibrator_;
  Correspondences features_;
  MotionEstimator::Estimate estimate_;
};

VisualOdometry::VisualOdometry(const Config& config)
    : pipeline_(std::make_unique<Pipeline>(config)) {}
VisualOdometry::~VisualOdometry() = default;
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;

OdometryResult VisualOdometry::process(const StereoPair& pair,
                                       const StereoCamera& camera,
                                       const std::optional<Eigen::Isometry3d>& expected) {
  return pipeline_->process(pair, camera, expected);
}

void VisualOdometry::reset() {
  pipeline_->reset();
}

const Correspondences& VisualOdometry::correspondences() const {
  return pipeline_->correspondences();
}
const FeatureSet& VisualOdometry::rotationInliers() const {
  return pipeline_->rotationInliers();
}
const FeatureSet& VisualOdometry::translationInliers() const {
  return pipeline_->translationInliers();
}

}  // namespace rotrocc
