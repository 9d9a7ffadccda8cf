#include "input/stamp_series.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr std::int64_t kPeriod_ns = 33'333'333;

TEST(StampSeriesTest, OneStampHasNoPeriod) {
  StampSeries series;
  EXPECT_FALSE(series.period_ns());
  series.add(5);
  EXPECT_FALSE(series.period_ns());
  series.add(5 + kPeriod_ns);
  EXPECT_EQ(series.period_ns(), kPeriod_ns);
}

TEST(StampSeriesTest, LostImagesAndGapsDoNotMatter) {
  std::mt19937 random(3);
  std::bernoulli_distribution lost(0.5);
  StampSeries series;
  for (int i = 0; i < 200; ++i) {
    if (!lost(random)) series.add(i * kPeriod_ns + (i > 100 ? 3'000'000'000 : 0));
    if (i < 30) continue;
    EXPECT_EQ(series.period_ns(), kPeriod_ns) << i;
  }
  EXPECT_EQ(series.stamps_ns().size(), StampSeries::kLength);
}

/// Stamps of the arrival: half of the steps are shorter than the period, but few by much.
TEST(StampSeriesTest, JitterShortensThePeriodByLittle) {
  std::mt19937 random(3);
  std::normal_distribution<double> jitter_ns(0.0, 3e6);
  StampSeries series;
  for (int i = 0; i < 200; ++i) {
    series.add(i * kPeriod_ns + std::llround(jitter_ns(random)));
    if (i < 30) continue;
    // The lower quartile of the steps, whose deviation is 4.2 ms, is 2.9 ms below the mean; from
    // 31 steps it varies by 1 ms.
    EXPECT_NEAR(*series.period_ns(), kPeriod_ns, 7e6) << i;
  }
}

TEST(StampSeriesTest, ATimeJumpIsNoStep) {
  StampSeries series;
  for (int loop = 0; loop < 10; ++loop) {
    for (int i = 0; i < 3; ++i) series.add(i * kPeriod_ns);
  }
  EXPECT_EQ(series.period_ns(), kPeriod_ns);
}

TEST(StampSeriesTest, TheShorterPeriodCounts) {
  StampSeries left, right;
  EXPECT_FALSE(commonPeriod_ns(left, right));
  for (int i = 0; i < 3; ++i) left.add(i * kPeriod_ns);
  EXPECT_EQ(commonPeriod_ns(left, right), kPeriod_ns);
  EXPECT_EQ(commonPeriod_ns(right, left), kPeriod_ns);
  for (int i = 0; i < 3; ++i) right.add(2 * i * kPeriod_ns);
  EXPECT_EQ(commonPeriod_ns(left, right), kPeriod_ns);
}

}  // namespace
}  // namespace rotrocc
