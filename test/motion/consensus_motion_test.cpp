#include "motion/consensus_motion.h"

#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr int kFeatures = 300;

/// 25 m/s at three images a second, far beyond what least squares from zero motion converge from
/// with wrong matches.
Eigen::Isometry3d farAhead() {
  return motion({0.2, -0.05, 7.5}, {0.01, 0.05, -0.01});
}

Correspondences withWrongMatches(double share) {
  std::mt19937 generator(7);
  Correspondences features =
      simulateFeatures(kittiCamera(), farAhead(), kFeatures, {0.1, 0.3}, generator);
  mismatch(features, 0, static_cast<std::size_t>(share * kFeatures), 60.0, generator);
  return features;
}

/// A start has to be so close that the features are found from there.
void expectStart(const std::optional<Eigen::Isometry3d>& found) {
  ASSERT_TRUE(found);
  const Vector6d error = motionError(*found, farAhead());
  EXPECT_LT(error.head<3>().norm(), 0.3);
  EXPECT_LT(error.tail<3>().norm(), 5e-3);
}

TEST(ConsensusMotionTest, IgnoresWrongMatches) {
  expectStart(consensusMotion(kittiCamera(), withWrongMatches(0.0)));
  const Correspondences features = withWrongMatches(0.5);
  const auto found = consensusMotion(kittiCamera(), features);
  expectStart(found);
  EXPECT_EQ(consensusMotion(kittiCamera(), features)->matrix(), found->matrix()) << "again";
}

TEST(ConsensusMotionTest, NeedsFourFeatures) {
  Correspondences features = withWrongMatches(0.0);
  features.resize(3);
  EXPECT_FALSE(consensusMotion(kittiCamera(), features));
  EXPECT_FALSE(consensusMotion(kittiCamera(), {}));
}

TEST(ConsensusMotionTest, GivesNothingOrANumberForEqualPoints) {
  Correspondences features = withWrongMatches(0.0);
  features.assign(10, features.front());
  const auto found = consensusMotion(kittiCamera(), features);
  EXPECT_TRUE(!found || found->matrix().allFinite());
}

}  // namespace
}  // namespace rotrocc
