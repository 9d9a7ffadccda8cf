#include "features/descriptor_matcher.h"

#include <algorithm>
#include <cmath>

#include "features/image_noise.h"

namespace rotrocc {
namespace {

/// Number of features: a third of them, matched rightly, is still plenty for RANSAC.
constexpr int kFeatures = 600;

/// Scales of the descriptors, in steps of a quarter: depths that change by a factor of two.
constexpr float kScaleStep = 1.25F;
constexpr int kScales = 4;

/// Contrast of a corner with the pixels around it, in standard deviations of the noise. Of those
/// that pass, the strongest are taken.
constexpr double kFastOverNoise = 4.0;

constexpr bool kEachOthersNearest = true;

}  // namespace

DescriptorMatcher::DescriptorMatcher(const StereoMatcherConfig& config)
    : matcher_(config),
      orb_(cv::ORB::create(kFeatures, kScaleStep, kScales)),
      nearest_(cv::NORM_HAMMING, kEachOthersNearest),
      workers_(1) {}

void DescriptorMatcher::describe(const cv::Mat& image,
                                 const FeatureMask& mask,
                                 Described& described) {
  const double sigma = std::sqrt(noiseVariance(image, noise_));
  orb_->setFastThreshold(std::max(1, cvRound(kFastOverNoise * sigma)));
  described.keypoints.clear();
  orb_->detectAndCompute(image, mask.usable(), described.keypoints, described.descriptors);
}

void DescriptorMatcher::match(const StereoCamera& camera,
                              const StereoFrame& earlier,
                              const StereoFrame& current,
                              double row_offset_px,
                              Correspondences& features) {
  features.clear();
  const cv::Mat& left = current.left.front();
  describe(left, current.left_mask, current_);
  if (current_.keypoints.empty()) return;
  describe(earlier.left.front(), earlier.left_mask, earlier_);
  if (earlier_.keypoints.empty()) return;
  nearest_.match(earlier_.descriptors, current_.descriptors, matches_);
  pixels_.clear();
  for (const cv::DMatch& match : matches_) {
    const cv::Point2f& px = current_.keypoints[static_cast<std::size_t>(match.trainIdx)].pt;
    pixels_.emplace_back(std::round(px.x), std::round(px.y));  // depths are found at whole pixels
  }
  const RectifiedImages images = {
      left, current.right.front(), camera.disparityAtInfinity(), row_offset_px};
  matcher_.match(workers_, images, pixels_, disparities_px_);
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    if (disparities_px_[i] == StereoMatcher::kNoDisparity) continue;
    const auto& in_earlier = earlier_.keypoints[static_cast<std::size_t>(matches_[i].queryIdx)].pt;
    const auto& in_current = current_.keypoints[static_cast<std::size_t>(matches_[i].trainIdx)].pt;
    features.push_back(
        {{in_earlier.x, in_earlier.y}, {in_current.x, in_current.y}, disparities_px_[i]});
  }
  triangulate(camera, features);
}

}  // namespace rotrocc
