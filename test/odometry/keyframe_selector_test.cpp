#include "odometry/keyframe_selector.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

/// Whether a keyframe serves after a step of this length, seen by `seen` of 400 features.
bool keeps(KeyframeSelector& selector, double step_m, int seen = 400) {
  const Eigen::Isometry3d T = motion({0.0, 0.0, step_m}, {0.0, 0.1, 0.0});
  std::mt19937 generator(1);
  const Correspondences features = simulateFeatures(kittiCamera(), T, 400, {}, generator);
  FeatureSet inliers(features.size(), 0);
  std::fill(inliers.begin(), inliers.begin() + seen, 1);
  return selector.keeps(kittiCamera(), features, inliers, T);
}

TEST(KeyframeSelectorTest, KeepsAReferenceWhileTheParallaxIsSmall) {
  KeyframeSelector selector({});
  // A rotation makes none.
  EXPECT_TRUE(keeps(selector, 0.0));
  EXPECT_TRUE(keeps(selector, 0.1));
  EXPECT_FALSE(keeps(selector, 3.0));
}

TEST(KeyframeSelectorTest, KeepsAReferenceWhileItIsSeen) {
  KeyframeSelector selector({});
  EXPECT_TRUE(keeps(selector, 0.0, 300));  // what the first pair sees is the measure
  EXPECT_TRUE(keeps(selector, 0.0, 211));
  EXPECT_FALSE(keeps(selector, 0.0, 209));
  selector.restart();
  EXPECT_TRUE(keeps(selector, 0.0, 209));
}

TEST(KeyframeSelectorTest, NeedsAFeature) {
  KeyframeSelector selector({});
  EXPECT_FALSE(keeps(selector, 0.0, 0));
}

TEST(KeyframeSelectorTest, TakesEveryPairIfNotAdaptive) {
  KeyframeSelector::Config config;
  config.adaptive = false;
  KeyframeSelector selector(config);
  EXPECT_FALSE(keeps(selector, 0.0));
}

}  // namespace
}  // namespace rotrocc
