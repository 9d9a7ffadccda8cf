#include "motion/motion_evidence.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr int kCount = 400;

class InformationShareTest : public testing::Test {
 protected:
  InformationShareTest() : features_(simulate(kCount)) {}

  Correspondences simulate(int count) {
    return simulateFeatures(kittiCamera(), motion_, count, {0.2, 0.2}, generator_);
  }

  double least(const FeatureSet& inliers) {
    return evidence_.informationShare({kittiCamera(), features_, 4.0}, motion_, inliers);
  }

  const Eigen::Isometry3d motion_ = motion({0.1, 0.0, 1.0}, {0.0, 0.02, 0.0});
  std::mt19937 generator_{1};
  Correspondences features_;
  MotionEvidence evidence_;
};

TEST_F(InformationShareTest, IsNearlyOneIfAllAreInliers) {
  const double share = least(FeatureSet(kCount, 1));
  EXPECT_LT(share, 1.0) << "one feature is left out";
  EXPECT_GT(share, 0.9);  // the leverage of one of 400 is 6/400 on average, of near ones more
}

TEST_F(InformationShareTest, IsThatOfTheInliersIfTheyAreLikeTheOthers) {
  FeatureSet inliers(kCount, 0);
  for (int i = 0; i < kCount; i += 2) inliers[static_cast<std::size_t>(i)] = 1;
  EXPECT_NEAR(least(inliers), 0.5, 0.2);  // in the least determined direction, fewer features count
}

TEST_F(InformationShareTest, IsSmallIfTheNearFeaturesAreOutliers) {
  FeatureSet inliers(kCount, 0);
  for (std::size_t i = 0; i < inliers.size(); ++i) inliers[i] = features_[i].point_cur.z() > 20.0;
  EXPECT_LT(least(inliers), 0.1);
}

TEST_F(InformationShareTest, DoesNotCountTheOneFeatureThatDeterminesTheMotion) {
  const Correspondence near = *std::min_element(
      features_.begin(), features_.end(), [](const Correspondence& a, const Correspondence& b) {
        return a.point_cur.z() < b.point_cur.z();
      });
  Correspondences far;
  for (const Correspondence& feature : features_) {
    if (feature.point_cur.z() > 30.0) far.push_back(feature);
  }
  features_ = far;
  features_.push_back(near);
  const FeatureSet all(features_.size(), 1);
  EXPECT_LT(least(all), 0.2);
  features_.insert(features_.end(), 9, near);
  EXPECT_GT(least(FeatureSet(features_.size(), 1)), 0.5);
}

TEST_F(InformationShareTest, IsZeroIfTheInliersDetermineNoMotion) {
  EXPECT_EQ(least(FeatureSet(kCount, 0)), 0.0);
  FeatureSet two(kCount, 0);
  two[0] = two[1] = 1;
  EXPECT_EQ(least(two), 0.0);
  features_.clear();
  EXPECT_EQ(least({}), 0.0);
}

}  // namespace
}  // namespace rotrocc
