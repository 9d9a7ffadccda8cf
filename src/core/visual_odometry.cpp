#include "rotrocc/visual_odometry.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

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

/// Ends the work on a pair: there is no motion, for a reason that is a sentence.
struct Lost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

void checkImage(const char* side, const cv::Mat& image, const StereoCamera& camera) {
  if (image.empty()) throw Lost(sentence("the ", side, " image is empty"));
  if (image.type() != CV_8UC1) {
    throw Lost(sentence("the ", side, " image is not 8-bit grey (OpenCV type ", image.type(), ")"));
  }
  if (image.cols != camera.width || image.rows != camera.height) {
    throw Lost(sentence("the ", side, " image is ", image.cols, "x", image.rows,
                        " px, but the camera ", camera.width, "x", camera.height));
  }
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

const char* toString(State state) {
  switch (state) {
    case State::kInitialising: return "initialising";
    case State::kOk: return "ok";
    case State::kDegraded: return "degraded";
    case State::kLost: return "lost";
  }
  return "unknown";
}

/// The stages in the order of section V, and what is kept from pair to pair.
class VisualOdometry::Pipeline {
 public:
  explicit Pipeline(const Config& config)
      : config_(config),
        detector_(config.feature_detector),
        matcher_(config.stereo_matcher),
        motion_model_(config.motion_model),
        tracker_(config.feature_tracker),
        estimator_(config.motion_estimator) {}

  OdometryResult process(const StereoPair& pair, const StereoCamera& camera) {
    OdometryResult result;
    result.stamp_ns = pair.stamp_ns;
    clearFeatures();
    {
      const StageTimer timer(result.times.total_ms);
      try {
        advance(pair, camera, result);
      } catch (const Lost& lost) {
        giveUp(lost.what(), result);
      } catch (const std::exception& error) {
        giveUp(sentence("internal error: ", error.what()), result);
      }
    }
    return result;
  }

  void reset() {
    has_previous_ = false;
    motion_model_.reset();
    clearFeatures();
  }

  const Correspondences& correspondences() const { return features_; }
  const FeatureSet& rotationInliers() const { return estimate_.rotation_inliers; }
  const FeatureSet& translationInliers() const { return estimate_.translation_inliers; }

 private:
  /// Level 0 of the pyramids are the images.
  struct Frame {
    std::int64_t stamp_ns = 0;
    FeatureTracker::Pyramid left, right;
  };

  void advance(const StereoPair& pair, const StereoCamera& camera, OdometryResult& result) {
    check(pair, camera);
    const std::string news = reasonToStart(pair, camera, result.dt_s);
    takePair(pair, camera, result.times);
    if (!news.empty()) {
      motion_model_.reset();
      result.state = State::kInitialising;
      result.reason = news;
      return;
    }
    findCorners(result);
    findDepths(result);
    findMotion(result);
    motion_model_.update(result.T_prev_cur, result.dt_s);
  }

  void check(const StereoPair& pair, const StereoCamera& camera) const {
    camera.check();
    checkImage("left", pair.left, camera);
    checkImage("right", pair.right, camera);
    if (has_previous_ && pair.stamp_ns <= current_.stamp_ns) {
      throw Lost(sentence("the stamp ", pair.stamp_ns, " ns is not later than that of the previous pair, ",
                          current_.stamp_ns, " ns"));
    }
  }

  /// Why the pair cannot be compared with the one before; empty, and sets `dt_s`, if it can.
  std::string reasonToStart(const StereoPair& pair, const StereoCamera& camera, double& dt_s) const {
    if (!has_previous_) return "first pair";
    if (camera != camera_) return "the camera has changed";
    const double gap_s = static_cast<double>(pair.stamp_ns - current_.stamp_ns) * 1e-9;
    if (gap_s > config_.max_gap_s) {
      return sentence("no pair for ", gap_s, " s, more than max_gap_s = ", config_.max_gap_s, " s");
    }
    dt_s = gap_s;
    return "";
  }

  void takePair(const StereoPair& pair, const StereoCamera& camera, StageTimes& times) {
    const StageTimer timer(times.pyramids_ms);
    has_previous_ = false;  // should the pyramids fail
    std::swap(previous_, current_);
    cv::parallel_for_(cv::Range(0, 2), [&](const cv::Range& range) {
      for (int i = range.start; i < range.end; ++i) {
        tracker_.buildPyramid(i == 0 ? pair.left : pair.right, i == 0 ? current_.left : current_.right);
      }
    });
    current_.stamp_ns = pair.stamp_ns;
    camera_ = camera;
    has_previous_ = true;
  }

  void findCorners(OdometryResult& result) {
    const StageTimer timer(result.times.corners_ms);
    detector_.detect(previous_.left.front(), corners_);
    result.counts.corners = static_cast<int>(corners_.size());
  }

  /// Triangulates the corners that have a match at t-1.
  void findDepths(OdometryResult& result) {
    const StageTimer timer(result.times.disparity_ms);
    matcher_.match(previous_.left.front(), previous_.right.front(), corners_, disparities_);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const double depth_m = camera_.depth(disparities_[i]);
      if (disparities_[i] == StereoMatcher::kNoDisparity || !(depth_m > 0.0)) continue;
      const cv::Point2f& corner = corners_[i];
      prev_left_.push_back(corner);
      prev_right_.emplace_back(corner.x - disparities_[i], corner.y);
      points_prev_.push_back(depth_m * camera_.ray({corner.x, corner.y}));
    }
    result.counts.with_depth = static_cast<int>(points_prev_.size());
  }

  /// With a prediction one round is enough. Without one, or where it proves wrong, tracking from a
  /// wrong place may lock on to a wrong motion: predict, track and estimate until it settles.
  void findMotion(OdometryResult& result) {
    const auto predicted = motion_model_.predict(result.dt_s);
    if (predicted) {
      trackAndEstimate(*predicted, config_.feature_tracker.levels, result);
      if (whyLost(result).empty()) return accept(result);
    }
    Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
    for (int round = 0; round < config_.startup_rounds; ++round) {
      trackAndEstimate(T_prev_cur, config_.feature_tracker.startup_levels, result);
      if (!estimate_.valid) break;
      const double change_px = medianShift(T_prev_cur, estimate_.T_prev_cur);
      T_prev_cur = estimate_.T_prev_cur;
      if (change_px < config_.startup_settled_px) break;
    }
    const std::string why = whyLost(result);
    if (!why.empty()) throw Lost(why);
    accept(result);
  }

  void trackAndEstimate(const Eigen::Isometry3d& predicted, int levels, OdometryResult& result) {
    {
      const StageTimer timer(result.times.tracking_ms);
      track(predicted, levels, result.counts);
      collectFeatures(result.counts);
    }
    const StageTimer timer(result.times.estimation_ms);
    estimate_ = estimator_.estimate(camera_, features_, predicted, result.dt_s);
    result.counts.rotation_inliers = count(estimate_.rotation_inliers);
    result.counts.translation_inliers =
        estimate_.has_translation_stage ? count(estimate_.translation_inliers) : 0;
  }

  /// Refines the predicted positions at t in the left and the right image.
  void track(const Eigen::Isometry3d& predicted, int levels, StageCounts& counts) {
    const Eigen::Isometry3d T_cur_prev = predicted.inverse();
    cur_left_.resize(points_prev_.size());
    cur_right_.resize(points_prev_.size());
    tracked_.assign(points_prev_.size(), 0);
    for (std::size_t i = 0; i < points_prev_.size(); ++i) {
      const Eigen::Vector3d point = T_cur_prev * points_prev_[i];
      if (point.z() < kMinDepth_m) continue;
      const Eigen::Vector2f left = camera_.project(point).cast<float>();
      cur_left_[i] = {left.x(), left.y()};
      cur_right_[i] = {left.x() - static_cast<float>(camera_.disparity(point.z())), left.y()};
      tracked_[i] = 1;
    }
    tracker_.track(previous_.left, current_.left, prev_left_, levels, cur_left_, tracked_);
    tracker_.track(previous_.right, current_.right, prev_right_, levels, cur_right_, tracked_);
    counts.tracked = count(tracked_);
  }

  /// Closes the circle at t: keeps the features whose left and right positions match each other.
  void collectFeatures(StageCounts& counts) {
    const auto& limits = config_.feature_tracker;
    expected_.assign(cur_left_.size(), StereoMatcher::kNoDisparity);
    for (std::size_t i = 0; i < cur_left_.size(); ++i) {
      if (tracked_[i] == 0 || std::abs(cur_left_[i].y - cur_right_[i].y) > limits.max_vertical_px) continue;
      expected_[i] = cur_left_[i].x - cur_right_[i].x;
    }
    matcher_.matchNear(current_.left.front(), current_.right.front(), cur_left_, expected_,
                       2, disparities_);
    features_.clear();
    static const int mode = getenv("DMODE") ? atoi(getenv("DMODE")) : 0;
    for (std::size_t i = 0; i < cur_left_.size(); ++i) {
      if (disparities_[i] == StereoMatcher::kNoDisparity ||
          std::abs(disparities_[i] - expected_[i]) > limits.max_disparity_difference_px) {
        continue;
      }
      Correspondence f;
      f.prev_px = {prev_left_[i].x, prev_left_[i].y};
      f.cur_px = {cur_left_[i].x, cur_left_[i].y};
      f.disparity_px = mode == 0 ? disparities_[i] : mode == 1 ? expected_[i] : 0.5 * (disparities_[i] + expected_[i]);
      const double depth_m = camera_.depth(f.disparity_px);
      if (!(depth_m > 0.0)) continue;
      f.point_cur = depth_m * camera_.ray(f.cur_px);
      features_.push_back(f);
    }
    counts.consistent = static_cast<int>(features_.size());
  }

  /// How far two motions predict the features from each other [px].
  double medianShift(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    const Eigen::Isometry3d a_inverse = a.inverse();
    const Eigen::Isometry3d b_inverse = b.inverse();
    shifts_px_.clear();
    for (const Eigen::Vector3d& point : points_prev_) {
      const Eigen::Vector3d by_a = a_inverse * point;
      const Eigen::Vector3d by_b = b_inverse * point;
      if (by_a.z() < kMinDepth_m || by_b.z() < kMinDepth_m) continue;
      shifts_px_.push_back((camera_.project(by_a) - camera_.project(by_b)).norm());
    }
    return median(shifts_px_);
  }

  /// Empty if the estimate can be believed.
  std::string whyLost(const OdometryResult& result) const {
    const int inliers = count(estimate_.translation_inliers);
    if (result.counts.consistent < config_.min_inliers) {
      return sentence("only ", result.counts.consistent, " features were tracked, fewer than min_inliers = ",
                      config_.min_inliers);
    }
    if (!estimate_.valid) return "the features fix no motion";
    if (inliers < config_.min_inliers) {
      return sentence("only ", inliers, " inliers, fewer than min_inliers = ", config_.min_inliers);
    }
    const double share = inlierShare(result);
    if (share < config_.min_inlier_share) {
      return sentence("only ", share, " of the features are inliers, less than min_inlier_share = ",
                      config_.min_inlier_share);
    }
    const double speed_mps = estimate_.T_prev_cur.translation().norm() / result.dt_s;
    if (speed_mps > config_.max_speed_mps) {
      return sentence("the estimated speed is ", speed_mps, " m/s, more than max_speed_mps = ",
                      config_.max_speed_mps);
    }
    const double turn_rate_rps = logRotation(estimate_.T_prev_cur.linear()).norm() / result.dt_s;
    if (turn_rate_rps > config_.max_turn_rate_rps) {
      return sentence("the estimated turn rate is ", turn_rate_rps,
                      " rad/s, more than max_turn_rate_rps = ", config_.max_turn_rate_rps);
    }
    return "";
  }

  double inlierShare(const OdometryResult& result) const {
    return static_cast<double>(count(estimate_.rotation_inliers)) / result.counts.consistent;
  }

  void accept(OdometryResult& result) const {
    result.T_prev_cur = estimate_.T_prev_cur;
    result.covariance = estimate_.covariance;
    result.state = State::kOk;
    const int inliers = count(estimate_.translation_inliers);
    const double share = inlierShare(result);
    if (inliers < config_.degraded_inliers) {
      result.state = State::kDegraded;
      result.reason = sentence("only ", inliers, " inliers");
    } else if (share < config_.degraded_inlier_share) {
      result.state = State::kDegraded;
      result.reason = sentence("only ", share, " of the features are inliers");
    }
  }

  void giveUp(const std::string& why, OdometryResult& result) {
    motion_model_.reset();
    result.state = State::kLost;
    result.reason = why;
  }

  void clearFeatures() {
    prev_left_.clear();
    prev_right_.clear();
    points_prev_.clear();
    features_.clear();
    estimate_ = {};
  }

  Config config_;
  FeatureDetector detector_;
  StereoMatcher matcher_;
  MotionModel motion_model_;
  FeatureTracker tracker_;
  MotionEstimator estimator_;

  bool has_previous_ = false;
  StereoCamera camera_;
  Frame previous_, current_;

  // Of the pair at work; members so that their memory is used again.
  std::vector<cv::Point2f> corners_, prev_left_, prev_right_, cur_left_, cur_right_;
  std::vector<float> disparities_, expected_;
  std::vector<Eigen::Vector3d> points_prev_;
  FeatureSet tracked_;
  Correspondences features_;
  MotionEstimator::Estimate estimate_;
  std::vector<double> shifts_px_;
};

VisualOdometry::VisualOdometry(const Config& config) : pipeline_(std::make_unique<Pipeline>(config)) {}
VisualOdometry::~VisualOdometry() = default;
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;

OdometryResult VisualOdometry::process(const StereoPair& pair, const StereoCamera& camera) {
  return pipeline_->process(pair, camera);
}

void VisualOdometry::reset() { pipeline_->reset(); }

const Correspondences& VisualOdometry::correspondences() const { return pipeline_->correspondences(); }
const FeatureSet& VisualOdometry::rotationInliers() const { return pipeline_->rotationInliers(); }
const FeatureSet& VisualOdometry::translationInliers() const {
  return pipeline_->translationInliers();
}

}  // namespace rotrocc
