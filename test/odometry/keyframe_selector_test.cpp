#include "odometry/keyframe_selector.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

/// Whether the keyframe is kept after a step of this length, with `seen` inliers of `searched`
/// features.
bool keeps(KeyframeSelector& selector,
           Keyframe& keyframe,
           double step_m,
           int seen = 400,
           int searched = 400) {
  std::mt19937 generator(1);
  Hypothesis accepted;
  accepted.camera = kittiCamera();
  accepted.counts.searched = searched;
  accepted.estimate.T_keyframe_cur = motion({0.0, 0.0, step_m}, {0.0, 0.1, 0.0});
  accepted.features =
      simulateFeatures(accepted.camera, accepted.estimate.T_keyframe_cur, searched, {}, generator);
  FeatureSet& inliers = accepted.estimate.rotation_inliers;
  inliers.assign(accepted.features.size(), 0);
  std::fill(inliers.begin(), inliers.begin() + seen, 1);
  return selector.keeps(accepted, keyframe);
}

TEST(KeyframeSelectorTest, KeepsAKeyframeWhileTheParallaxIsSmall) {
  KeyframeSelector selector({});
  Keyframe keyframe;
  // Rotation causes no parallax.
  EXPECT_TRUE(keeps(selector, keyframe, 0.0));
  EXPECT_TRUE(keeps(selector, keyframe, 0.1));
  EXPECT_FALSE(keeps(selector, keyframe, 3.0));
}

TEST(KeyframeSelectorTest, KeepsAKeyframeWhileItIsSeen) {
  KeyframeSelector selector({});
  Keyframe keyframe;
  EXPECT_TRUE(keeps(selector, keyframe, 0.0, 300));  // sets the inliers of the first motion
  EXPECT_TRUE(keeps(selector, keyframe, 0.0, 211));
  EXPECT_FALSE(keeps(selector, keyframe, 0.0, 209));
  Keyframe other;
  EXPECT_TRUE(keeps(selector, other, 0.0, 209));
}

TEST(KeyframeSelectorTest, ComparesSharesIfAPartIsSearched) {
  KeyframeSelector selector({});
  Keyframe keyframe;
  EXPECT_TRUE(keeps(selector, keyframe, 0.0, 300));
  EXPECT_TRUE(keeps(selector, keyframe, 0.0, 53, 100));
  EXPECT_FALSE(keeps(selector, keyframe, 0.0, 52, 100));
}

TEST(KeyframeSelectorTest, NeedsAFeature) {
  KeyframeSelector selector({});
  Keyframe keyframe;
  EXPECT_FALSE(keeps(selector, keyframe, 0.0, 0));
}

TEST(KeyframeSelectorTest, TakesEveryFrameIfNotAdaptive) {
  KeyframeSelector::Config config;
  config.adaptive = false;
  KeyframeSelector selector(config);
  Keyframe keyframe;
  EXPECT_FALSE(keeps(selector, keyframe, 0.0));
}

}  // namespace
}  // namespace rotrocc
