#include "odometry/keyframe_selector.h"

#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

/// Whether the keyframe is kept after a motion, if the flow has this noise.
bool keeps(const Eigen::Isometry3d& T_keyframe_cur,
           double noise_px = 0.2,
           int features = 400,
           const KeyframeSelector::Config& config = {}) {
  std::mt19937 generator(1);
  Hypothesis accepted;
  accepted.camera = kittiCamera();
  accepted.estimate.T_keyframe_cur = T_keyframe_cur;
  accepted.estimate.flow_noise_px = noise_px;
  accepted.features =
      simulateFeatures(accepted.camera, T_keyframe_cur, features, {noise_px, noise_px}, generator);
  accepted.estimate.rotation_inliers.assign(accepted.features.size(), 1);
  return KeyframeSelector(config).keeps(accepted);
}

const Eigen::Isometry3d kRest = Eigen::Isometry3d::Identity();

TEST(KeyframeSelectorTest, KeepsAKeyframeAtRest) {
  EXPECT_TRUE(keeps(kRest));
  EXPECT_FALSE(keeps(motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0})));
  EXPECT_FALSE(keeps(motion({0.0, 0.0, 0.0}, {0.0, 0.01, 0.0}))) << "7 px at this focal length";
}

TEST(KeyframeSelectorTest, RestIsRelativeToTheNoise) {
  const Eigen::Isometry3d slow = motion({0.0, 0.0, 0.0}, {0.0, 0.004, 0.0});  // 2.9 px
  EXPECT_FALSE(keeps(slow, 0.2));
  EXPECT_TRUE(keeps(slow, 0.4));
}

TEST(KeyframeSelectorTest, NeedsAFeature) {
  EXPECT_FALSE(keeps(kRest, 0.2, 0));
}

TEST(KeyframeSelectorTest, TakesEveryFrameIfNotAdaptive) {
  KeyframeSelector::Config config;
  config.adaptive = false;
  EXPECT_FALSE(keeps(kRest, 0.2, 400, config));
}

}  // namespace
}  // namespace rotrocc
