#include "features/descriptor_matcher.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/features2d.hpp>

#include "common/image_grid.h"
#include "features/image_noise.h"

namespace rotrocc {
namespace {

/// Features of an image: one for so many pixels, up to a number. Where depths change by half, a
/// tenth of them is matched rightly.
constexpr int kPixels = 200;
constexpr int kMaxFeatures = 1500;

/// Matches that are used: in each cell of the image, those with the most similar descriptors.
/// Nearly half of these are right where a tenth of all are.
constexpr int kColumns = 4;
constexpr int kRows = 2;
constexpr int kMatches = 12;

/// What moves less in the image looks most similar, as the robot's own parts do, and would be many
/// of these. That the camera rests was tried before. In pixels of detail.
constexpr double kRest_px = 2.0;

/// Scales of the descriptors, in steps of a quarter: depths that change by a factor of two.
constexpr float kScaleStep = 1.25F;
constexpr int kScales = 4;

/// Contrast of a corner with the pixels around it, in standard deviations of the noise. Of those
/// that pass, the strongest are taken.
constexpr double kFastOverNoise = 4.0;

struct Described {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

Described describe(const cv::Mat& image, const FeatureMask& mask) {
  const double sigma = std::sqrt(noiseVariance(image));
  const int count = std::min(static_cast<int>(image.total()) / kPixels, kMaxFeatures);
  const auto orb = cv::ORB::create(count, kScaleStep, kScales);
  orb->setFastThreshold(std::max(1, cvRound(kFastOverNoise * sigma)));
  Described described;
  orb->detectAndCompute(
      image, mask.usable(image.size()), described.keypoints, described.descriptors);
  return described;
}

}  // namespace

Correspondences matchDescriptors(const StereoCamera& camera,
                                 const Keyframe& keyframe,
                                 const StereoFrame& current,
                                 const StereoMatcher& depths) {
  const Described in_current = describe(current.left.front(), current.left_mask);
  if (in_current.keypoints.empty()) return {};
  const Described in_earlier = describe(keyframe.frame->left.front(), keyframe.frame->left_mask);
  if (in_earlier.keypoints.empty()) return {};
  std::vector<cv::DMatch> matches;
  cv::BFMatcher(cv::NORM_HAMMING, true)  // each other's nearest
      .match(in_earlier.descriptors, in_current.descriptors, matches);
  std::stable_sort(matches.begin(), matches.end());  // by the distance
  const RectifiedImages images = {
      current.left.front(), current.right.front(), camera, keyframe.row_offset_px};
  const ImageGrid grid(camera.width, camera.height, kColumns, kRows);
  std::vector<int> counts(grid.count(), 0);
  Correspondences features;
  for (const cv::DMatch& match : matches) {
    const auto& earlier = in_earlier.keypoints[static_cast<std::size_t>(match.queryIdx)].pt;
    const auto& cur = in_current.keypoints[static_cast<std::size_t>(match.trainIdx)].pt;
    if (cv::norm(cur - earlier) < kRest_px * camera.detail_px) continue;
    const cv::Point2f pixel(std::round(cur.x), std::round(cur.y));  // depths are at whole pixels
    const auto depth = depths.match(images, pixel);
    if (!depth || counts[grid.cell(cur.x, cur.y)]++ >= kMatches) continue;
    features.push_back({{earlier.x, earlier.y}, {cur.x, cur.y}, depth->disparity_px});
  }
  triangulate(camera, features);
  return features;
}

}  // namespace rotrocc
