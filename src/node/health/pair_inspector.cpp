#include "node/health/pair_inspector.h"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "features/image_noise.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr int kFewCorners = 50;
constexpr double kFewShare = 0.2;  // of the corners that have a disparity
/// Row offsets tried on images that do not match; matches must exceed chance.
constexpr int kOffsets_px[] = {2, 4, 7, 12, 20};
constexpr double kClearlyMore = 2.0;
/// Ratio of contrasts that causes a hint: one stop. On real clips, right images with half of their
/// contrast cost nothing.
constexpr double kApart = 2.0;
/// Share of the gains that is dropped at either end: single pairs may be wrong.
constexpr double kDropped = 0.1;

/// The image shifted down by `rows`, or up if negative.
cv::Mat shifted(const cv::Mat& image, int rows) {
  cv::Mat result = cv::Mat::zeros(image.size(), image.type());
  const int kept = image.rows - std::abs(rows);
  image.rowRange(std::max(-rows, 0), std::max(-rows, 0) + kept)
      .copyTo(result.rowRange(std::max(rows, 0), std::max(rows, 0) + kept));
  return result;
}

/// Counts the corners of an image that have a disparity.
class MatchCounter {
 public:
  MatchCounter(const CorrespondenceFinder::Config& config, const StereoCamera& camera)
      : detector_(config.feature_detector), matcher_(config.stereo_matcher), camera_(camera) {}

  int count(const cv::Mat& left, const cv::Mat& right, bool swapped = false) {
    detector_.detect(alone_, left, corners_);
    StereoCamera camera = camera_;
    if (swapped) std::swap(camera.cx, camera.cx_right);
    matcher_.match(alone_, {left, right, camera}, corners_, disparities_);
    return static_cast<int>(
        std::count_if(disparities_.begin(), disparities_.end(), [](float disparity_px) {
          return disparity_px != StereoMatcher::kNoDisparity;
        }));
  }

  /// Of the last image.
  int corners() const { return static_cast<int>(corners_.size()); }

 private:
  Workers alone_{1};
  FeatureDetector detector_;
  StereoMatcher matcher_;
  StereoCamera camera_;
  std::vector<cv::Point2f> corners_;
  std::vector<float> disparities_;
};

/// Why a pair has no motion, as far as its images tell; empty if they do not.
std::string explainLoss(const cv::Mat& left,
                        const cv::Mat& right,
                        MatchCounter& matches,
                        bool rectifies,
                        int significant_bits) {
  const int direct = matches.count(left, right);
  if (matches.corners() < kFewCorners || isNoise(left)) {
    return "the left image has hardly any corners, its mean grey level is " +
           toText(cvRound(cv::mean(left)[0])) + " of 255" +
           (significant_bits == 8
                ? ""
                : ", where 255 is " + toText((1 << significant_bits) - 1) +
                      " of the 16-bit image: set significant_bits if it should be another value") +
           ": is it dark, overexposed or out of focus, or the lens covered?";
  }
  if (cv::norm(left, right, cv::NORM_INF) == 0.0) {
    return "left and right image are identical: are both topics from the same camera?";
  }
  const bool few = direct < kFewShare * matches.corners();
  const double clearly_more = kClearlyMore * std::max(direct, kFewCorners);
  if (matches.count(right, left, true) > clearly_more) {
    return "the images match if left and right are swapped: swap their topics";
  }
  for (const int offset : kOffsets_px) {
    for (const int rows : {offset, -offset}) {
      if (matches.count(left, shifted(right, rows)) < clearly_more) continue;
      return "the images match if the right one is shifted by about " + toText(rows) + " rows: " +
             (rectifies ? "K, D, R or P of camera_info are wrong; recalibrate"
                        : "they are not rectified; remap to rectified images, set the parameter "
                          "rectify for raw ones, or recalibrate");
    }
  }
  if (!few) return "";
  return "hardly any corner matches in the right image: are the images rectified and synchronized, "
         "and is nearest_baselines small enough for near objects?";
}

}  // namespace

PairInspector::PairInspector(const CorrespondenceFinder::Config& config, bool rectifies)
    : rectifies_(rectifies), config_(config) {}

void PairInspector::configure(const CorrespondenceFinder::Config& config) {
  config_ = config;
  forgetLoss();
}

std::string PairInspector::inspect(const StereoPair& pair,
                                   const StereoCamera& camera,
                                   const OdometryResult& result,
                                   int significant_bits) {
  const std::string fault = compareExposures(result);
  // Of a pair that was not tried the odometry knows why.
  if (result.state == State::kInitialising || result.counts.tries == 0) return fault;
  if (result.state == State::kOk) {
    // Chance matches may look like a motion: one of them takes back few of the doubts.
    doubtful_ -= 1 + doubtful_ / kPatience;
    explain_at_ = std::min(explain_at_, std::max(kPatience, 2 * doubtful_));
    if (doubtful_ <= 0) forgetLoss();
    return fault;
  }
  ++doubtful_;
  try {
    explain(pair, camera, significant_bits);
  } catch (const std::exception&) {
    return fault;  // no memory, or no thread
  }
  return explanation_.empty() ? fault : explanation_;
}

/// Takes over the explanation if there is a new one, and looks for the next one if it is time.
/// Throws std::exception if it cannot be looked for.
void PairInspector::explain(const StereoPair& pair,
                            const StereoCamera& camera,
                            int significant_bits) {
  if (search_.valid()) {
    if (search_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    const std::string found = search_.get();
    if (search_is_of_this_loss_) explanation_ = found;
  }
  if (doubtful_ < explain_at_) return;
  explain_at_ = 2 * doubtful_;
  search_is_of_this_loss_ = true;
  search_ = std::async(std::launch::async,
                       [left = pair.left.clone(),
                        right = pair.right.clone(),
                        matches = MatchCounter(config_, camera),
                        rectifies = rectifies_,
                        significant_bits]() mutable {
                         pthread_setname_np(pthread_self(), "odometry_hint");
                         return explainLoss(left, right, matches, rectifies, significant_bits);
                       });
}

void PairInspector::forgetLoss() {
  doubtful_ = 0;
  explain_at_ = kPatience;
  explanation_.clear();
  search_is_of_this_loss_ = false;
}

void PairInspector::finish() const {
  if (search_.valid()) search_.wait();
}

std::string PairInspector::compareExposures(const OdometryResult& result) {
  constexpr const char* kRemedy = ": couple the exposures of the cameras";
  if (result.hasMotion()) gains_.push_back(result.exposure_gain);
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
