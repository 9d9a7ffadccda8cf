#include "node/health/loss_explanation.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// An image as the odometry sees it, see OdometryResult::halvings.
cv::Mat usedImage(const cv::Mat& image, int halvings) {
  cv::Mat used = image;
  if (halvings < 0) enlarge(image, used);
  for (int i = 0; i < halvings; ++i) halve(cv::Mat(used), used);
  return used;
}

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
        left_(usedImage(left, result.halvings)),
        right_(usedImage(right, result.halvings)),
        corrected_px_(std::ldexp(result.row_offset.applied_px, -result.halvings)) {
    FeatureDetector(config.feature_detector).detect(left_, corners_);
  }

  /// In right rows that are `lower_px` lower than the odometry expects.
  int count(int lower_px = 0) const {
    const RectifiedImages images = {left_, right_, camera_, corrected_px_ + lower_px};
    return static_cast<int>(
        std::count_if(corners_.begin(), corners_.end(), [&](const cv::Point2f& corner) {
          return matcher_.match(images, corner).has_value();
        }));
  }

  int corners() const { return static_cast<int>(corners_.size()); }
  int rows() const { return left_.rows; }

 private:
  StereoMatcher matcher_;
  StereoCamera camera_;
  cv::Mat left_, right_;
  double corrected_px_;
  std::vector<cv::Point2f> corners_;
};

/// Whether the features that agree with the last motion stand still in the image.
bool standsStill(const VisualOdometry& odometry, double flow_noise_px) {
  constexpr double kOverNoise = 3.0;
  return medianFlow_px(odometry.correspondences(), odometry.translationInliers()) <=
         kOverNoise * flow_noise_px;
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

}  // namespace

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
    return {cv::format("the left image of %dx%d pixels", left.cols, left.rows) +
            " has hardly any corners, its mean gray level is " +
            toText(cvRound(cv::mean(left)[0])) + " of 255" +
            (range.white() == 255
                 ? ""
                 : ", where 0 is " + toText(range.black) + " and 255 is " + toText(range.white()) +
                       " of the 16-bit image: set significant_bits if that is wrong") +
            ": is it too small, dark, overexposed or out of focus, or the lens covered?"};
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

}  // namespace rotrocc
