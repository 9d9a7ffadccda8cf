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
      nearest_(cv::NORM_HAMMING, kEachOthersNearest) {}

DescriptorMatcher::Described DescriptorMatcher::describe(const cv::Mat& image,
                                                         const FeatureMask& mask) {
  std::vector<int> responses;
  const double sigma = std::sqrt(noiseVariance(image, responses));
  orb_->setFastThreshold(std::max(1, cvRound(kFastOverNoise * sigma)));
  Described described;
  orb_->detectAndCompute(
      image, mask.usable(image.size()), described.keypoints, described.descriptors);
  return described;
}

Correspondences DescriptorMatcher::match(const StereoCamera& camera,
                                         const StereoFrame& earlier,
                                         const StereoFrame& current,
                                         double row_offset_px) {
  const cv::Mat& left = current.left.front();
  const Described in_current = describe(left, current.left_mask);
  if (in_current.keypoints.empty()) return {};
  const Described in_earlier = describe(earlier.left.front(), earlier.left_mask);
  if (in_earlier.keypoints.empty()) return {};
  std::vector<cv::DMatch> matches;
  nearest_.match(in_earlier.descriptors, in_current.descriptors, matches);
  std::vector<cv::Point2f> pixels;
  for (const cv::DMatch& match : matches) {
    const cv::Point2f& px = in_current.keypoints[static_cast<std::size_t>(match.trainIdx)].pt;
    pixels.emplace_back(std::round(px.x), std::round(px.y));  // depths are found at whole pixels
  }
  const RectifiedImages images = {left, current.right.front(), camera, row_offset_px};
  std::vector<float> disparities_px;
  matcher_.match(images, pixels, disparities_px);
  Correspondences features;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (disparities_px[i] == StereoMatcher::kNoDisparity) continue;
    const auto& keyframe_px =
        in_earlier.keypoints[static_cast<std::size_t>(matches[i].queryIdx)].pt;
    const auto& cur_px = in_current.keypoints[static_cast<std::size_t>(matches[i].trainIdx)].pt;
    features.push_back({{keyframe_px.x, keyframe_px.y}, {cur_px.x, cur_px.y}, disparities_px[i]});
  }
  triangulate(camera, features);
  return features;
}

}  // namespace rotrocc
