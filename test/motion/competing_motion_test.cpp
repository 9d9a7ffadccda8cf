#include "motion/competing_motion.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr int kInliers = 300;
constexpr int kOthers = 60;

/// Features of the camera's motion, and then others.
class CompetingMotionTest : public testing::Test {
 protected:
  /// `count` features with that motion and a depth between the limits.
  void add(const Eigen::Isometry3d& T_keyframe_cur, int count, double min_m, double max_m) {
    const std::size_t size = features_.size() + static_cast<std::size_t>(count);
    while (features_.size() < size) {
      const Correspondence feature =
          simulateFeatures(kittiCamera(), T_keyframe_cur, 1, {0.1, 0.1}, generator_).front();
      const double depth_m = feature.point_cur.z();
      if (min_m < depth_m && depth_m < max_m) features_.push_back(feature);
    }
  }

  CompetingMotion::Competitors find(int min_count) {
    FeatureSet inliers(features_.size(), 0);
    std::fill(inliers.begin(), inliers.begin() + kInliers, 1);
    return competing_motion_.find(kittiCamera(), features_, motion_, inliers, min_count);
  }

  const Eigen::Isometry3d motion_ = motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  const Eigen::Isometry3d other_ = motion({0.5, 0.0, 0.2}, {0.0, 0.02, 0.0});
  std::mt19937 generator_{1};
  Correspondences features_;
  CompetingMotion competing_motion_;
};

TEST_F(CompetingMotionTest, AreCounted) {
  add(motion_, kInliers, 10.0, 30.0);
  EXPECT_EQ(find(1).count, 0);
  add(other_, kOthers, 10.0, 30.0);
  const CompetingMotion::Competitors competitors = find(kOthers / 2);
  EXPECT_GT(competitors.count, 0.8 * kOthers) << competitors.count;
  EXPECT_LE(competitors.count, kOthers);
  EXPECT_FALSE(competitors.are_behind);
  EXPECT_EQ(find(kOthers + 1).count, 0);
}

TEST_F(CompetingMotionTest, MayBeBehind) {
  add(motion_, kInliers, 5.0, 10.0);
  add(other_, kOthers, 20.0, 40.0);
  const CompetingMotion::Competitors competitors = find(kOthers / 2);
  EXPECT_GE(competitors.count, kOthers / 2);
  EXPECT_TRUE(competitors.are_behind);
}

TEST_F(CompetingMotionTest, AgreeOnSomething) {
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
