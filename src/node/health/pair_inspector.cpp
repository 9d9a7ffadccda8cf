#include "node/health/pair_inspector.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "common/median.h"
#include "features/correspondence_finder.h"
#include "features/image_noise.h"
#include "features/image_pyramid.h"
#include "features/row_search.h"
#include "input/to_text.h"
#include "motion/feature_errors.h"

namespace rotrocc {
namespace {

constexpr int kFewCorners = 50;
constexpr double kFewShare = 0.2;  // of corners that match beyond chance, or agree on a motion
constexpr double kClearlyMore = 2.0;
/// How many more features agree if one side is late.
constexpr double kClearlyMoreAgree = 1.5;
/// Share of the features that agree on the motion of a pair.
constexpr double kMostAgree = 0.8;
/// Searches that find nothing, after which an explanation no longer holds.
constexpr int kSearches = 2;
/// Ratio of contrasts that causes a hint: one stop. On real clips, right images with half of their
/// contrast cost nothing.
constexpr double kApart = 2.0;
/// Share of the gains that is dropped at either end: single pairs may be wrong.
constexpr double kDropped = 0.1;

/// Counts the corners of the left image that have a disparity, in the images as the odometry sees
/// them: in soft ones that are not halved, half of the corners match by chance.
class MatchCounter {
 public:
  MatchCounter(const CorrespondenceFinder::Config& config,
               const cv::Mat& left,
               const cv::Mat& right,
               const StereoCamera& camera,
               const OdometryResult& result)
      : matcher_(config.stereo_matcher),
        camera_(camera.halved(result.halvings)),
        corrected_px_(std::ldexp(result.row_offset.applied_px, -result.halvings)) {
    buildPyramid(left, result.halvings + 1, 0, left_);
    buildPyramid(right, result.halvings + 1, 0, right_);
    FeatureDetector(config.feature_detector).detect(left_.back(), corners_);
  }

  /// In right rows that are `lower_px` lower than the odometry expects.
  int count(int lower_px = 0) const {
    const RectifiedImages images = {left_.back(), right_.back(), camera_, corrected_px_ + lower_px};
    return static_cast<int>(
        std::count_if(corners_.begin(), corners_.end(), [&](const cv::Point2f& corner) {
          return matcher_.match(images, corner).has_value();
        }));
  }

  int corners() const { return static_cast<int>(corners_.size()); }
  int rows() const { return left_.back().rows; }

 private:
  StereoMatcher matcher_;
  ImagePyramid left_, right_;
  StereoCamera camera_;
  double corrected_px_;
  std::vector<cv::Point2f> corners_;
};

/// Whether the features that agree with the last motion stand still in the image.
bool standsStill(const VisualOdometry& odometry, double flow_noise_px) {
  constexpr double kOverNoise = 3.0;
  return medianFlow_px(odometry.correspondences(), odometry.translationInliers()) <=
         kOverNoise * flow_noise_px;
}

/// The features that agree on the motion from a pair to the next.
struct Agreement {
  std::size_t count;
  bool is_clear;  ///< the motion is not in doubt, or more agree on it than by chance
  bool stands_still;
};

Agreement agreementOf(OdometryConfig config,
                      const StereoCamera& camera,
                      const StereoPair& earlier,
                      const StereoPair& later) {
  VisualOdometry odometry(config);
  odometry.process(earlier, camera);
  const OdometryResult result = odometry.process(later, camera);
  const FeatureSet& inliers = odometry.translationInliers();
  const auto count = static_cast<std::size_t>(std::count(inliers.begin(), inliers.end(), 1));
  const double few = kFewShare * config.correspondence_finder.feature_detector.max_features;
  return {count,
          result.state == State::kOk || static_cast<double>(count) > few,
          standsStill(odometry, result.flow_noise_px)};
}

StereoPair paired(const StereoPair& of_left, const StereoPair& of_right) {
  return StereoPair{std::max(of_left.stamp_ns, of_right.stamp_ns),
                    of_left.left,
                    of_right.right,
                    of_left.left_mask,
                    of_right.right_mask};
}

StereoPair exchanged(const StereoPair& pair) {
  return StereoPair{pair.stamp_ns, pair.right, pair.left, pair.right_mask, pair.left_mask};
}

std::string lateText(const std::string& side, const std::string& other, bool is_next) {
  return "the " + side + " images are " + (is_next ? "one frame" : "two frames") +
         " late: they match the " + other + " images of the " +
         (is_next ? "previous pair" : "pair before the previous one") +
         "; look for a queue in the driver, or for a trigger that one camera misses";
}

/// Which other images are the pairs, if more features agree on a motion between those; empty if
/// none are. `may_be_swapped`: more corners have a disparity if left and right are swapped.
std::string whichArePairs(const std::vector<StereoPair>& pairs,
                          const OdometryConfig& config,
                          const StereoCamera& camera,
                          bool may_be_swapped) {
  if (pairs.size() < 2) return "";
  const std::size_t last = pairs.size() - 1;
  const Agreement direct = agreementOf(config, camera, pairs[last - 1], pairs[last]);
  auto most = static_cast<std::size_t>(kClearlyMoreAgree * static_cast<double>(direct.count));
  std::string text;
  const auto tryPairs = [&](const StereoCamera& of,
                            const StereoPair& earlier,
                            const StereoPair& later,
                            bool is_of_one_moment,
                            const std::string& explanation) {
    const Agreement agreement = agreementOf(config, of, earlier, later);
    // What stands still while the rest moves, as a part of the robot, is of any moment and place.
    const bool may_stand_still = is_of_one_moment && direct.stands_still;
    const bool shows_it = agreement.is_clear && (may_stand_still || !agreement.stands_still);
    if (!shows_it || agreement.count <= most) return;
    most = agreement.count;
    text = explanation;
  };
  for (std::size_t frames = 1; frames < last; ++frames) {
    const StereoPair &early = pairs[last - frames], &earlier = pairs[last - frames - 1];
    const bool is_next = frames == 1;
    tryPairs(camera,
             paired(earlier, pairs[last - 1]),
             paired(early, pairs[last]),
             false,
             lateText("right", "left", is_next));
    tryPairs(camera,
             paired(pairs[last - 1], earlier),
             paired(pairs[last], early),
             false,
             lateText("left", "right", is_next));
  }
  if (!may_be_swapped) return text;
  StereoCamera swapped = camera;
  std::swap(swapped.cx, swapped.cx_right);
  tryPairs(swapped,
           exchanged(pairs[last - 1]),
           exchanged(pairs[last]),
           true,
           "the images match if left and right are swapped: swap their topics");
  return text;
}

/// The right rows in which most corners match, except those that the odometry searches.
struct OtherRows {
  int lower_px = 0;
  int count = 0;
  int by_chance = 0;  ///< the median: most rows are wrong
};

OtherRows searchRows(const MatchCounter& matches) {
  constexpr int kStep = 2;                // windows match in the rows beside theirs
  constexpr double kMostRows = 1.0 / 16;  // of the image: as much as raw images are apart
  constexpr int kNearest = RowSearch::kMaxRows + 1;  // in soft images it searches more
  const int farthest = std::max(kNearest, cvRound(kMostRows * matches.rows()));
  OtherRows found;
  std::vector<int> counts;
  for (int rows = kNearest; rows <= farthest; rows += kStep) {
    for (const int lower_px : {rows, -rows}) {
      counts.push_back(matches.count(lower_px));
      if (counts.back() <= found.count) continue;
      found.count = counts.back();
      found.lower_px = lower_px;
    }
  }
  found.by_chance = median(counts);
  return found;
}

/// Why the last of some pairs has no motion, as far as the images show; empty if they do not.
Explanation explainLoss(const std::vector<StereoPair>& pairs,
                        const OdometryConfig& config,
                        const StereoCamera& camera,
                        const OdometryResult& result,
                        bool rectifies,
                        const GrayRange& range) {
  const cv::Mat &left = pairs.back().left, &right = pairs.back().right;
  const auto between = [&](const cv::Mat& image, const cv::Mat& other) {
    return MatchCounter(config.correspondence_finder, image, other, camera, result);
  };
  const MatchCounter matches = between(left, right);
  if (matches.corners() < kFewCorners || isNoise(left)) {
    return {"the left image has hardly any corners, its mean gray level is " +
            toText(cvRound(cv::mean(left)[0])) + " of 255" +
            (range.white() == 255
                 ? ""
                 : ", where 0 is " + toText(range.black) + " and 255 is " + toText(range.white()) +
                       " of the 16-bit image: set significant_bits if that is wrong") +
            ": is it dark, overexposed or out of focus, or the lens covered?"};
  }
  if (cv::norm(left, right, cv::NORM_INF) == 0.0) {
    return {"left and right image are identical: are both topics from the same camera?", true};
  }
  const int direct = matches.count();
  // What stands still agrees also by chance.
  const bool may_be_swapped = between(right, left).count() > direct;
  if (const std::string pairs_are = whichArePairs(pairs, config, camera, may_be_swapped);
      !pairs_are.empty()) {
    return {pairs_are, true};
  }
  const OtherRows other = searchRows(matches);
  const double few = kFewShare * matches.corners();
  if (other.count - other.by_chance >= std::max(kClearlyMore * (direct - other.by_chance), few)) {
    return {"the images match if the right one is shifted by about " +
            toText(-cvRound(result.row_offset.applied_px +
                            std::ldexp(other.lower_px, result.halvings))) +
            " rows: " +
            (rectifies ? "K, D, R or P of camera_info are wrong; recalibrate"
                       : "they are not rectified; remap to rectified images, set the parameter "
                         "rectify for raw ones, or recalibrate")};
  }
  if (direct - other.by_chance >= few) return {};
  return {
      "hardly any corner matches in the right image, except by chance: are the images rectified "
      "and synchronized, and is nearest_baselines small enough for near objects?",
      false,
      true};
}

}  // namespace

StereoPair copyOf(StereoPair pair) {
  pair.left = pair.left.clone();
  pair.right = pair.right.clone();
  return pair;
}

PairInspector::PairInspector(const OdometryConfig& config, bool rectifies)
    : rectifies_(rectifies), config_(config) {}

void PairInspector::configure(const OdometryConfig& config) {
  config_ = config;
  reset();
}

std::string PairInspector::inspect(const StereoPair& pair,
                                   const StereoCamera& camera,
                                   const OdometryResult& result,
                                   const GrayRange& range,
                                   const PairsBefore& before) {
  const std::string fault = compareExposures(result);
  // Of a pair that was not tried the odometry knows why.
  if (result.state == State::kInitializing || result.counts.tries == 0) return fault;
  if (result.state == State::kOk) {
    // Chance matches may look like a motion: one of them takes back few of the doubts.
    doubtful_ -= 1 + doubtful_ / kPatience;
    explain_at_ = std::min(explain_at_, std::max(kPatience, 2 * doubtful_));
    if (doubtful_ <= 0) reset();
    return fault;
  }
  ++doubtful_;
  try {
    explain(pair, camera, result, range, before);
  } catch (const std::exception&) {
    return fault;  // no memory, or no thread
  }
  return explanation_.text.empty() ? fault : explanation_.text;
}

/// Takes over the explanation if there is a new one, and looks for the next one if it is time.
/// Throws std::exception if it cannot be looked for.
void PairInspector::explain(const StereoPair& pair,
                            const StereoCamera& camera,
                            const OdometryResult& result,
                            const GrayRange& range,
                            const PairsBefore& before) {
  if (search_.valid()) {
    if (search_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    finish();
  }
  if (doubtful_ < explain_at_) return;
  explain_at_ = 2 * doubtful_;
  search_is_of_this_loss_ = true;
  std::vector<StereoPair> pairs;
  try {
    if (before) pairs = before();
  } catch (const std::exception&) {  // one of them is damaged: lateness is not reported
  }
  pairs.push_back(copyOf(pair));
  search_ = std::async(
      std::launch::async,
      [pairs = std::move(pairs), config = config_, camera, result, rectifies = rectifies_, range] {
        pthread_setname_np(pthread_self(), "odometry_hint");
        return explainLoss(pairs, config, camera, result, rectifies, range);
      });
}

OdometryResult PairInspector::distrusted(OdometryResult result) const {
  if (!isOfNoPair() || !result.hasMotion()) return result;
  if (result.counts.rotation_inliers >= kMostAgree * result.counts.consistent) {
    result.state = State::kDegraded;
    result.reason = "left and right images did not match shortly before";
    return result;
  }
  result.state = State::kLost;
  result.reason = "left and right images do not match";
  result.T_prev_cur.setIdentity();
  result.covariance.setZero();
  result.contrast_gain = result.flow_noise_px = 0.0;
  return result;
}

void PairInspector::reset() {
  doubtful_ = 0;
  explain_at_ = kPatience;
  explanation_ = {};
  search_is_of_this_loss_ = false;
  found_nothing_ = 0;
}

std::string PairInspector::finish() {
  if (search_.valid()) {
    const Explanation found = search_.get();
    if (!search_is_of_this_loss_) return explanation_.text;
    // Not each pair shows it.
    const bool is_less = found.is_guess && !explanation_.text.empty();
    found_nothing_ = found.text.empty() || is_less ? found_nothing_ + 1 : 0;
    if (found_nothing_ == 0 || found_nothing_ >= kSearches) explanation_ = found;
  }
  return explanation_.text;
}

bool PairInspector::isUnexplained() const {
  return found_nothing_ >= kSearches && explanation_.text.empty();
}

std::string RecordingInspector::inspect(const StereoPair& pair,
                                        const StereoCamera& camera,
                                        const OdometryResult& result) {
  const std::string fault = inspector_.inspect(pair, camera, result, {}, [&] { return before_; });
  const std::string explanation = inspector_.finish();
  countReordered(result);
  const bool is_doubtful = result.state == State::kLost || result.state == State::kDegraded;
  if (is_doubtful && result.counts.tries > 0) trySinglePair(pair, camera);
  before_.push_back(copyOf(pair));
  if (before_.size() > kPairsBefore) before_.erase(before_.begin());
  if (result.state == State::kOk) last_ok_ = before_.back();
  return explanation.empty() ? fault : explanation;
}

/// The same pair with other images, from which the motion since the last good pair is found.
void RecordingInspector::trySinglePair(const StereoPair& pair, const StereoCamera& camera) {
  if (!last_ok_ || tried_ == kSinglePairs) return;
  ++tried_;
  const auto agreesMore = [&](const StereoPair& other, std::size_t count) {
    const Agreement agreement = agreementOf(config_, camera, *last_ok_, other);
    return agreement.is_clear && !agreement.stands_still && agreement.count > count;
  };
  const StereoPair& earlier = before_.back();
  const std::size_t few = agreementOf(config_, camera, *last_ok_, pair).count;
  const auto clearly_more = static_cast<std::size_t>(kClearlyMoreAgree * static_cast<double>(few));
  if (agreesMore(exchanged(pair), clearly_more)) {
    ++explained_
        ["match if left and right are swapped: look for a driver that mixes up its cameras"];
  } else if (agreesMore(paired(pair, earlier), clearly_more) ||
             agreesMore(paired(earlier, pair), clearly_more)) {
    ++explained_
        ["match an image of the previous pair: look for a driver that sends images of one "
         "camera in the wrong order"];
  }
}

/// Of two pairs that are exchanged: a step twice as long, one back, and another twice as long.
void RecordingInspector::countReordered(const OdometryResult& result) {
  ++pairs_;
  constexpr std::size_t kSteps = 4;
  constexpr double kSigmas = 5.0, kAlike = 0.5;
  const double sigma_m = std::sqrt(result.covariance.topLeftCorner<3, 3>().trace());
  const Eigen::Vector3d step_m = result.T_prev_cur.translation();
  if (!result.hasMotion() || step_m.norm() < kSigmas * sigma_m) return steps_m_.clear();
  steps_m_.push_back(step_m);
  if (steps_m_.size() > kSteps) steps_m_.erase(steps_m_.begin());
  if (steps_m_.size() < kSteps) return;
  const Eigen::Vector3d& step = steps_m_.front();
  const auto isStep = [&](std::size_t i, double times) {
    return (steps_m_[i] - times * step).norm() < kAlike * step.norm();
  };
  if (isStep(1, 2.0) && isStep(2, -1.0) && isStep(3, 2.0)) ++reordered_;
}

std::string RecordingInspector::faultOfSinglePairs() const {
  constexpr int kLeast = 2, kOfPairs = 4;  // a quarter: a wrong image may cost two pairs or more
  constexpr int kOfSteps = 100;            // fewer may be vibrations of a handheld camera
  if (reordered_ >= kLeast && kOfSteps * reordered_ >= pairs_) {
    return "the camera seems to go back for one pair " + toText(reordered_) +
           " times, as if two pairs were exchanged: look for a driver or recorder that changes the "
           "order of images";
  }
  for (const auto& [text, count] : explained_) {
    if (count < kLeast || kOfPairs * count < tried_) continue;
    return "of the first " + toText(tried_) + " lost or degraded pairs, " + toText(count) + " " +
           text;
  }
  return "";
}

std::string PairInspector::compareExposures(const OdometryResult& result) {
  constexpr const char* kRemedy = ": couple the exposures of the cameras";
  if (result.hasMotion()) gains_.push_back(result.contrast_gain);
  if (gains_.size() < kMinExposures) return "";
  const double least = quantileOf(gains_, kDropped);
  const double most = quantileOf(gains_, 1.0 - kDropped);
  if (most > kApart * least) {
    return "the right camera's contrast moves between " + hundredths(least) + " and " +
           hundredths(most) + " times the left one's" + kRemedy;
  }
  const double typical = quantileOf(gains_, 0.5);
  if (std::max(typical, 1.0 / typical) <= kApart) return "";
  return "the right camera's contrast is " + hundredths(typical) + " times the left one's" +
         kRemedy;
}

}  // namespace rotrocc
