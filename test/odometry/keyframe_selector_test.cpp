#include "odometry/keyframe_selector.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

/// Whether the keyframe is kept after a step of this length, with `seen` inliers of 400 features.
bool keeps(KeyframeSelector& selector, Keyframe& keyframe, double step_m, int seen = 400) {
  const Eigen::Isometry3d T = motion({0.0, 0.0, step_m}, {0.0, 0.1, 0.0});
  std::mt19937 generator(1);
  const Correspondences features = simulateFeatures(kittiCamera(), T, 400, {}, generator);
  FeatureSet inliers(features.size(), 0);
  std::fill(inliers.begin(), inliers.begin() + seen, 1);
  return selector.keeps(kittiCamera(), features, inliers, T, keyframe);
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
