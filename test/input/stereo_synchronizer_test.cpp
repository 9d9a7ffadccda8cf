#include "input/stereo_synchronizer.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include "input/message_conversion.h"

namespace rotrocc {
namespace {

constexpr double kMaxDifference_s = 0.01;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

sensor_msgs::Image::ConstPtr makeImage(double stamp_ms) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  // An epoch as of a real robot, where a double would lose nanoseconds.
  image->header.stamp =
      toRosTime(1'600'000'000'000'000'000 + static_cast<std::int64_t>(stamp_ms * kMillisecond_ns));
  return image;
}

class StereoSynchronizerTest : public testing::Test {
 protected:
  /// Whether an image completes a pair.
  bool left(double stamp_ms) { return take(synchronizer_.addLeft(makeImage(stamp_ms))); }
  bool right(double stamp_ms) { return take(synchronizer_.addRight(makeImage(stamp_ms))); }

  /// Right minus left stamp of the last pair [ms].
  double skew_ms() const {
    return 1e3 * (pair_.right->header.stamp - pair_.left->header.stamp).toSec();
  }

  StereoSynchronizer synchronizer_{kMaxDifference_s, 4};
  StereoImages pair_;

 private:
  bool take(const std::optional<StereoImages>& pair) {
    if (pair) pair_ = *pair;
    return pair.has_value();
  }
};

TEST_F(StereoSynchronizerTest, SecondImageCompletesThePair) {
  EXPECT_FALSE(left(0));
  EXPECT_TRUE(right(0));
  EXPECT_EQ(skew_ms(), 0.0);
  EXPECT_FALSE(right(100));
  EXPECT_TRUE(left(100));
  EXPECT_EQ(synchronizer_.unmatched(), 0u);
}

TEST_F(StereoSynchronizerTest, ToleranceIsInclusive) {
  EXPECT_FALSE(left(0));
  EXPECT_TRUE(right(10));
  EXPECT_FALSE(left(100));
  EXPECT_FALSE(right(110.001));
}

TEST_F(StereoSynchronizerTest, NearestCandidateWins) {
  EXPECT_FALSE(right(93));
  EXPECT_FALSE(right(102));
  EXPECT_FALSE(right(107));
  EXPECT_TRUE(left(100));
  EXPECT_NEAR(skew_ms(), 2.0, 1e-9);
  EXPECT_EQ(synchronizer_.unmatched(), 1u);  // 93 cannot be matched any more; 107 still can
  EXPECT_TRUE(left(108));
  EXPECT_NEAR(skew_ms(), -1.0, 1e-9);
}

TEST_F(StereoSynchronizerTest, OneSideMayBeLate) {
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(left(100.0 * i));
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(right(100.0 * i + 3.0)) << i;
  EXPECT_EQ(synchronizer_.unmatched(), 0u);
}

TEST_F(StereoSynchronizerTest, QueuesAreBounded) {
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(left(100.0 * i));
  EXPECT_EQ(synchronizer_.unmatched(), 6u);
  EXPECT_FALSE(right(500));  // was discarded
  EXPECT_TRUE(right(600));
  EXPECT_TRUE(right(900));
}

TEST_F(StereoSynchronizerTest, SkippedImagesAreUnmatched) {
  EXPECT_FALSE(left(0));
  EXPECT_FALSE(left(100));
  EXPECT_TRUE(right(100));
  EXPECT_EQ(synchronizer_.unmatched(), 1u);
  EXPECT_FALSE(right(0));  // late, or after a time jump: waits
}

TEST_F(StereoSynchronizerTest, RepeatedStampsAreNotLookedAt) {
  EXPECT_FALSE(left(0));
  EXPECT_FALSE(left(0));
  EXPECT_TRUE(right(0));
  EXPECT_FALSE(right(0));
  EXPECT_FALSE(left(0));
  EXPECT_EQ(synchronizer_.unmatched(), 3u);
}

TEST_F(StereoSynchronizerTest, SurvivesTimeThatJumpsBack) {
  EXPECT_FALSE(left(900));
  EXPECT_TRUE(right(900));
  EXPECT_FALSE(left(1000));
  // The bag restarts. The left side jumps first, before the last right image arrives.
  EXPECT_FALSE(left(0));
  EXPECT_FALSE(right(1001));
  EXPECT_TRUE(right(0));
  EXPECT_EQ(skew_ms(), 0.0);
  EXPECT_FALSE(left(100));
  EXPECT_TRUE(right(100));
  EXPECT_EQ(synchronizer_.unmatched(), 2u);
}

TEST_F(StereoSynchronizerTest, OneSideMayBeAheadAfterTimeJumpsBack) {
  EXPECT_FALSE(left(900));
  EXPECT_TRUE(right(900));
  EXPECT_FALSE(left(0));
  EXPECT_FALSE(left(100));
  EXPECT_TRUE(right(0));
  EXPECT_TRUE(right(100));
  EXPECT_EQ(synchronizer_.unmatched(), 0u);
}

TEST_F(StereoSynchronizerTest, ResetForgetsWhatWaits) {
  EXPECT_FALSE(left(0));
  synchronizer_.reset();
  EXPECT_FALSE(right(0));
  EXPECT_TRUE(left(0));
}

TEST_F(StereoSynchronizerTest, StampsAtTheEndOfTimeDoNoHarm) {
  const auto late = boost::make_shared<sensor_msgs::Image>();
  late->header.stamp = ros::TIME_MAX;
  const auto early = boost::make_shared<sensor_msgs::Image>();
  EXPECT_FALSE(synchronizer_.addLeft(late));
  EXPECT_FALSE(synchronizer_.addRight(early));
  EXPECT_TRUE(synchronizer_.addRight(late));
  EXPECT_FALSE(synchronizer_.addLeft(early));  // its partner was discarded
  EXPECT_TRUE(synchronizer_.addRight(early));
}

/// A camera at 30 Hz whose user has raised the tolerance beyond half a period.
class WideToleranceTest : public StereoSynchronizerTest {
 protected:
  static constexpr double kPeriod_ms = 1000.0 / 30.0;

  WideToleranceTest() { synchronizer_ = StereoSynchronizer(0.04, 4); }
};

TEST_F(WideToleranceTest, LostImagesLeaveTheOthersTogether) {
  std::mt19937 random(5);
  std::bernoulli_distribution lost(0.3);
  for (const bool left_too : {false, true}) {
    int both = 0, pairs = 0;
    for (int i = 0; i < 500; ++i) {
      const bool has_left = i < 2 || !left_too || !lost(random);
      const bool has_right = i < 2 || !lost(random);
      both += has_left && has_right ? 1 : 0;
      const bool right_first = i % 3 == 0;
      for (const bool is_right : {right_first, !right_first}) {
        if (is_right ? !has_right : !has_left) continue;
        if (!(is_right ? right(i * kPeriod_ms) : left(i * kPeriod_ms))) continue;
        ++pairs;
        EXPECT_EQ(skew_ms(), 0.0) << i;
      }
    }
    EXPECT_EQ(pairs, both);
  }
}

TEST_F(WideToleranceTest, AnOddStartDoesNoHarm) {
  EXPECT_FALSE(left(0));
  EXPECT_FALSE(right(kPeriod_ms));  // the right image of 0 is lost
  EXPECT_TRUE(left(kPeriod_ms));
  EXPECT_EQ(skew_ms(), 0.0);
  EXPECT_EQ(synchronizer_.unmatched(), 1u);
}

/// Two images alone do not tell whether they are of one time: the next one does.
TEST_F(WideToleranceTest, TheFirstPairOfSkewedCamerasIsNotLost) {
  EXPECT_FALSE(left(0));
  EXPECT_FALSE(right(15));
  EXPECT_TRUE(left(kPeriod_ms));
  EXPECT_NEAR(skew_ms(), 15.0, 1e-9);
  for (int i = 1; i < 20; ++i) {
    EXPECT_TRUE(right(15 + i * kPeriod_ms)) << i;
    EXPECT_NEAR(skew_ms(), 15.0, 1e-3);
    EXPECT_FALSE(left((i + 1) * kPeriod_ms)) << i;
  }
  EXPECT_EQ(synchronizer_.unmatched(), 0u);
}

TEST_F(WideToleranceTest, ToleranceIsAtMostHalfThePeriod) {
  EXPECT_NEAR(synchronizer_.tolerance_s(), 0.01, 1e-9) << "while no period is known";
  for (int i = 0; i < 5; ++i) right(i * kPeriod_ms);
  EXPECT_NEAR(synchronizer_.tolerance_s(), 0.5e-3 * kPeriod_ms, 1e-6);
  for (int i = 0; i < 5; ++i) left(2 * i * kPeriod_ms);
  EXPECT_NEAR(synchronizer_.tolerance_s(), 0.5e-3 * kPeriod_ms, 1e-6);
}

/// The raw drives of KITTI as kitti2bag records them: a frame each 0.1 s, give or take 5 ms, whose
/// right image is up to 7 ms apart, all images in the order of their own stamps.
TEST_F(StereoSynchronizerTest, MatchesEveryPairOfAnUnsynchronisedDrive) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter_ms(-5.0, 5.0);
  std::uniform_real_distribution<double> skew(-7.0, 7.0);
  constexpr int kPairs = 400;
  std::vector<std::pair<double, bool>> arrivals;
  for (int i = 0; i < kPairs; ++i) {
    const double left_ms = 100.0 * i + jitter_ms(random);
    arrivals.emplace_back(left_ms, true);
    arrivals.emplace_back(left_ms + skew(random), false);
  }
  std::sort(arrivals.begin(), arrivals.end());
  int pairs = 0;
  for (const auto& [stamp_ms, is_left] : arrivals) {
    if (!(is_left ? left(stamp_ms) : right(stamp_ms))) continue;
    ++pairs;
    EXPECT_LE(std::abs(skew_ms()), 7.0);
  }
  EXPECT_EQ(pairs, kPairs);
  EXPECT_EQ(synchronizer_.unmatched(), 0u);
}

}  // namespace
}  // namespace rotrocc
