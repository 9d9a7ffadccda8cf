#include "motion/rival_motion.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr int kInliers = 300;
constexpr int kOthers = 60;

/// Features of the camera's motion, and then others.
class RivalMotionTest : public testing::Test {
 protected:
  /// `count` features with that motion and a depth between the limits.
  void add(const Eigen::Isometry3d& T_keyframe_cur, int count, double least_m, double most_m) {
    const std::size_t size = features_.size() + static_cast<std::size_t>(count);
    while (features_.size() < size) {
      const Correspondence feature =
          simulateFeatures(kittiCamera(), T_keyframe_cur, 1, {0.1, 0.1}, generator_).front();
      const double depth_m = feature.point_cur.z();
      if (least_m < depth_m && depth_m < most_m) features_.push_back(feature);
    }
  }

  RivalMotion::Rivals find(int least) {
    FeatureSet inliers(features_.size(), 0);
    std::fill(inliers.begin(), inliers.begin() + kInliers, 1);
    return rival_motion_.find(kittiCamera(), features_, motion_, inliers, least);
  }

  const Eigen::Isometry3d motion_ = motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  const Eigen::Isometry3d other_ = motion({0.5, 0.0, 0.2}, {0.0, 0.02, 0.0});
  std::mt19937 generator_{1};
  Correspondences features_;
  RivalMotion rival_motion_;
};

TEST_F(RivalMotionTest, AreCounted) {
  add(motion_, kInliers, 10.0, 30.0);
  EXPECT_EQ(find(1).count, 0);
  add(other_, kOthers, 10.0, 30.0);
  const RivalMotion::Rivals rivals = find(kOthers / 2);
  EXPECT_GT(rivals.count, 0.8 * kOthers) << rivals.count;
  EXPECT_LE(rivals.count, kOthers);
  EXPECT_FALSE(rivals.are_behind);
  EXPECT_EQ(find(kOthers + 1).count, 0);
}

TEST_F(RivalMotionTest, MayBeBehind) {
  add(motion_, kInliers, 5.0, 10.0);
  add(other_, kOthers, 20.0, 40.0);
  const RivalMotion::Rivals rivals = find(kOthers / 2);
  EXPECT_GE(rivals.count, kOthers / 2);
  EXPECT_TRUE(rivals.are_behind);
}

TEST_F(RivalMotionTest, AgreeOnSomething) {
  add(motion_, kInliers, 10.0, 30.0);
  add(motion_, kOthers, 10.0, 30.0);
  std::uniform_real_distribution<double> offset_px(-40.0, 40.0);
  for (std::size_t i = kInliers; i < features_.size(); ++i) {
    features_[i].keyframe_px += Eigen::Vector2d(offset_px(generator_), offset_px(generator_));
  }
  EXPECT_EQ(find(kOthers / 2).count, 0);
}

}  // namespace
}  // namespace rotrocc
