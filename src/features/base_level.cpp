#include "features/base_level.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "features/image_noise.h"

namespace rotrocc {
namespace {

/// Images that an average is over: the sharpness of single ones moves by a factor of 3.
constexpr int kImages = 20;

/// A level is soft below this sharpness. Of sharp cameras it is 0.7 to 1.3 (KITTI, Karlsruhe), of
/// soft ones 0.35 to 0.54 (EuRoC, a rover, handheld), of images at twice their size 0.2 to 0.33.
constexpr double kSoft = 0.6;
/// The next level has all of the details of one below this sharpness.
constexpr double kEmpty = 0.22;
constexpr double kHysteresis = 1.2;

/// The window of the tracker.
constexpr double kWindow_px2 = 9.0 * 9.0;
/// Windows that a feature needs in a halved image. With 3.6, KITTI at twice its size has a tenth
/// more error at each fourth pair.
constexpr double kRoom = 3.9;
/// Images with fewer are doubled, which halves the error of KITTI's images at 320 px and each third
/// pair. At 160 px there is no motion without. A window of a doubled image has half as many
/// details: too few in a soft one.
constexpr double kLeastRoom = 3.0;
constexpr double kLeastRoomIfSoft = 2.0;

/// Weight of the last pair in the share of features that survive. A smaller share counts at once.
constexpr double kMoreSurvive = 0.2;

/// Pixels of an image that are compared, about.
constexpr double kSample = 1000.0;

/// What is left of the variance of white noise after halving, (70 / 256)^2, and of its difference
/// to the pixels that are kept, 1 - 2 * 36 / 256 + (70 / 256)^2.
constexpr double kNoiseOfHalf = 0.0748;
constexpr double kNoiseOfLoss = 0.794;

/// Mean square of what the half image has lost [gray levels^2].
double lossOf(const cv::Mat& image, const cv::Mat& half) {
  const int step = std::max(1, cvFloor(std::sqrt(static_cast<double>(half.total()) / kSample)));
  double sum = 0.0;
  int count = 0;
  for (int y = 0; 2 * y < image.rows; y += step) {
    const auto* fine = image.ptr<uchar>(2 * y);
    const auto* coarse = half.ptr<uchar>(y);
    for (int x = 0; 2 * x < image.cols; x += step) {
      const int difference = fine[2 * x] - coarse[x];
      sum += difference * difference;
      ++count;
    }
  }
  return sum / count;
}

/// Of an image, by the two smaller ones, each half of the previous one; none if they show nothing.
std::optional<double> sharpnessOf(const cv::Mat& image, const cv::Mat* smaller) {
  constexpr double kLeast = 0.01;
  const double noise = kNoiseOfLoss * noiseVariance(image);
  const double lost = lossOf(image, smaller[0]) - noise;
  const double next = lossOf(smaller[0], smaller[1]) - kNoiseOfHalf * noise;
  if (!(next > kNoiseOfHalf * noise)) return std::nullopt;
  return std::max(lost / next, kLeast);
}

}  // namespace

void BaseLevel::observe(const cv::Mat& image, const ImagePyramid& pyramid) {
  const int levels = std::min<int>(kMaxLevel + 1, static_cast<int>(pyramid.size()) - 2);
  const auto windowsFor = [&](int features, const cv::Mat& level) {
    return static_cast<double>(level.total()) / kWindow_px2 / features;
  };
  for (level_ = 0; level_ < levels; ++level_) {
    const bool is_last = level_ + 1 == levels;
    const auto hasRoomFor = [&](int features) {
      return !is_last && windowsFor(features, pyramid[level_ + 1]) >= kRoom;
    };
    if (level_ < config_.min_halvings && hasRoomFor(wantedFeatures())) continue;
    observeLevel(level_ == 0 ? image : pyramid[level_], &pyramid[level_ + 1]);
    const bool is_left = is_soft_[level_] && hasRoomFor(config_.max_features);
    if (is_last || !(is_empty_[level_] || is_left)) break;
  }
  // Enlarging an image by a factor divides its sharpness by about the square of the factor.
  const auto level = static_cast<std::size_t>(level_);
  const double side_px = is_soft_[level] ? std::exp(-0.5 * log_sharpness_[level]) : 1.0;
  detail_px_ = window_scale_ = std::max(1.0, side_px);
  const double windows = windowsFor(config_.max_features, image);
  if (level_ > 0 || windows >= (is_soft_[0] ? kLeastRoomIfSoft : kLeastRoom)) return;
  level_ = -1;
  detail_px_ *= 2.0;
  // As large as the window of a whole image, if four of them have room for each feature.
  window_scale_ = std::clamp(std::sqrt(windows), 1.0, detail_px_);
}

void BaseLevel::observeLevel(const cv::Mat& image, const cv::Mat* smaller) {
  const auto sharpness = sharpnessOf(image, smaller);
  if (!sharpness) return;
  images_[level_] = std::min(images_[level_] + 1, kImages);
  log_sharpness_[level_] += (std::log(*sharpness) - log_sharpness_[level_]) / images_[level_];
  const auto compare = [&](double limit, bool& is_below) {
    is_below = log_sharpness_[level_] < std::log(is_below ? kHysteresis * limit : limit);
  };
  compare(kSoft, is_soft_[level_]);
  compare(kEmpty, is_empty_[level_]);
}

void BaseLevel::observeSurvivors(double share) {
  const double more = survivors_ == 0.0 ? share : survivors_ + kMoreSurvive * (share - survivors_);
  survivors_ = std::min(share, more);
}

int BaseLevel::wantedFeatures() const {
  const double least = static_cast<double>(config_.wanted_inliers) / config_.max_features;
  return cvRound(config_.wanted_inliers / std::max(survivors_, least));
}

}  // namespace rotrocc
