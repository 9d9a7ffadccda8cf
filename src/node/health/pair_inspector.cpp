#include "node/health/pair_inspector.h"

#include <algorithm>
#include <cstring>

#include <opencv2/imgproc.hpp>

#include "features/image_noise.h"
#include "input/to_text.h"

namespace rotrocc {
namespace {

constexpr int kFewCorners = 50;
constexpr double kFewShare = 0.2;  // of the corners that have a disparity
/// Interval of repeated inspections during a loss, in pairs.
constexpr int kPatienceAgain = 100;
constexpr int kRowStep = 8;  // sampling of rows
/// Row offsets tried on images that do not match; matches must exceed chance.
constexpr int kOffsets_px[] = {2, 4, 7, 12, 20};
constexpr double kClearlyMore = 2.0;
/// Ratio of contrasts that causes a hint: one stop. On real clips, right images with half of their
/// contrast cost nothing.
constexpr double kApart = 2.0;
/// Share of the gains that is dropped at either end: single pairs may be wrong.
constexpr double kDropped = 0.1;

/// A hash of some rows of an image (FNV-1a over 8 bytes at a time).
std::uint64_t fingerprint(const cv::Mat& image) {
  constexpr std::uint64_t kPrime = 1099511628211u;
  std::uint64_t print = 14695981039346656037u;
  for (int y = 0; y < image.rows; y += kRowStep) {
    const unsigned char* row = image.ptr(y);
    int x = 0;
    for (; x + 8 <= image.cols; x += 8) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, row + x, 8);
      print = (print ^ bytes) * kPrime;
    }
    for (; x < image.cols; ++x) print = (print ^ row[x]) * kPrime;
  }
  return print;
}

/// The image shifted down by `rows`, or up if negative.
cv::Mat shifted(const cv::Mat& image, int rows) {
  cv::Mat result = cv::Mat::zeros(image.size(), image.type());
  const int kept = image.rows - std::abs(rows);
  image.rowRange(std::max(-rows, 0), std::max(-rows, 0) + kept)
      .copyTo(result.rowRange(std::max(rows, 0), std::max(rows, 0) + kept));
  return result;
}

std::string frozenText(const std::string& which, int pairs) {
  return which + " has been unchanged for " + toText(pairs) + " pairs: is the camera frozen?";
}

}  // namespace

PairInspector::PairInspector(const CorrespondenceFinder::Config& config, bool rectifies)
    : rectifies_(rectifies), detector_(config.feature_detector), matcher_(config.stereo_matcher) {}

void PairInspector::configure(const CorrespondenceFinder::Config& config) {
  detector_ = FeatureDetector(config.feature_detector);
  matcher_ = StereoMatcher(config.stereo_matcher);
  doubtful_ = 0;
  explanation_.clear();
}

std::string PairInspector::inspect(const StereoPair& pair,
                                   const StereoCamera& camera,
                                   const OdometryResult& result) {
  const std::string exposures = compareExposures(result);
  std::string fault = findFrozen(pair);
  if (fault.empty()) fault = exposures;
  if (result.state == State::kInitialising) return fault;
  // Chance matches may occasionally look like a motion.
  doubtful_ = result.state == State::kOk ? 0 : doubtful_ + 1;
  const bool shows_nothing =
      result.counts.corners < kFewCorners || (result.state == State::kLost && isNoise(pair.left));
  few_corners_ = shows_nothing ? few_corners_ + 1 : 0;
  if (doubtful_ == 0) explanation_.clear();
  if (few_corners_ >= kPatience) {
    return "the left image has hardly any corners, its mean grey level is " +
           toText(cvRound(cv::mean(pair.left)[0])) +
           " of 255: is it dark, overexposed or out of focus, or the lens covered?";
  }
  if (few_corners_ == 0 &&
      (doubtful_ == kPatience || (doubtful_ > 0 && doubtful_ % kPatienceAgain == 0))) {
    explanation_ = explainLoss(pair, camera);
  }
  return explanation_.empty() ? fault : explanation_;
}

std::string PairInspector::findFrozen(const StereoPair& pair) {
  const std::uint64_t left_print = fingerprint(pair.left);
  const std::uint64_t right_print = fingerprint(pair.right);
  left_frozen_ = left_print == left_print_ ? left_frozen_ + 1 : 0;
  right_frozen_ = right_print == right_print_ ? right_frozen_ + 1 : 0;
  left_print_ = left_print;
  right_print_ = right_print;
  const bool left = left_frozen_ >= kPatience;
  const bool right = right_frozen_ >= kPatience;
  if (left && right) return frozenText("each image", std::min(left_frozen_, right_frozen_));
  if (left) return frozenText("the left image", left_frozen_);
  if (right) return frozenText("the right image", right_frozen_);
  return "";
}

std::string PairInspector::compareExposures(const OdometryResult& result) {
  constexpr const char* kRemedy = ": couple the exposures of the cameras";
  if (result.hasMotion()) gains_.add(result.exposure_gain);
  if (gains_.size() < kMinExposures) return "";
  const double least = gains_.quantile(kDropped);
  const double most = gains_.quantile(1.0 - kDropped);
  if (most > kApart * least) {
    return "the right camera's contrast moves between " + hundredths(least) + " and " +
           hundredths(most) + " times the left one's" + kRemedy;
  }
  const double typical = gains_.quantile(0.5);
  if (std::max(typical, 1.0 / typical) <= kApart) return "";
  return "the right camera's contrast is " + hundredths(typical) + " times the left one's" +
         kRemedy;
}

/// Whether the grey levels hardly vary more than their noise, as behind a covered lens.
bool PairInspector::isNoise(const cv::Mat& image) {
  constexpr double kOverNoise = 2.0;
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image, mean, deviation);
  return deviation[0] * deviation[0] < kOverNoise * kOverNoise * noiseVariance(image, noise_);
}

std::string PairInspector::explainLoss(const StereoPair& pair, const StereoCamera& camera) {
  if (cv::norm(pair.left, pair.right, cv::NORM_INF) == 0.0) {
    return "left and right image are identical: are both topics from the same camera?";
  }
  const double infinity_px = camera.disparityAtInfinity();
  const int matches = countMatches(pair.left, pair.right, infinity_px);
  const bool few = matches < kFewShare * static_cast<double>(corners_.size());
  const double clearly_more = kClearlyMore * std::max(matches, kFewCorners);
  if (countMatches(pair.right, pair.left, -infinity_px) > clearly_more) {
    return "the images match if left and right are swapped: swap their topics";
  }
  for (const int offset : kOffsets_px) {
    for (const int rows : {offset, -offset}) {
      if (countMatches(pair.left, shifted(pair.right, rows), infinity_px) < clearly_more) continue;
      return "the images match if the right one is shifted by about " + toText(rows) + " rows: " +
             (rectifies_ ? "K, D, R or P of camera_info are wrong; recalibrate"
                         : "they are not rectified; remap to rectified images, set the parameter "
                           "rectify for raw ones, or recalibrate");
    }
  }
  if (!few) return "";
  return "hardly any corner matches in the right image: are the images rectified and synchronized, "
         "and is max_disparity_px large enough for near objects?";
}

/// Corners of `left` that have a disparity.
int PairInspector::countMatches(const cv::Mat& left, const cv::Mat& right, double infinity_px) {
  detector_.detect(alone_, left, corners_);
  matcher_.match(alone_, {left, right, infinity_px}, corners_, disparities_);
  return static_cast<int>(
      std::count_if(disparities_.begin(), disparities_.end(), [](float disparity_px) {
        return disparity_px != StereoMatcher::kNoDisparity;
      }));
}

}  // namespace rotrocc
