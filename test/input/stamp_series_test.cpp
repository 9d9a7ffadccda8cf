#include "input/stamp_series.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr std::int64_t kPeriod_ns = 33'333'333;

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

TEST(StampSeriesTest, TheShorterPeriodCountsAndATimeJumpIsNoStep) {
  StampSeries left, right;
  left.add(0);
  EXPECT_FALSE(commonPeriod_ns(left, right));
  for (int i = 0; i < 30; ++i) left.add(i % 3 * kPeriod_ns);
  EXPECT_EQ(commonPeriod_ns(left, right), kPeriod_ns);
  EXPECT_EQ(commonPeriod_ns(right, left), kPeriod_ns);
  for (int i = 0; i < 3; ++i) right.add(2 * i * kPeriod_ns);
  EXPECT_EQ(commonPeriod_ns(left, right), kPeriod_ns);
}

constexpr double kPeriod_s = 1.0 / 30.0;
constexpr std::int64_t kNow_ns = 1'600'000'000'000'000'000;

StampSeries makeSeries(const std::vector<double>& stamps_s) {
  StampSeries series;
  for (const double stamp_s : stamps_s) series.add(kNow_ns + std::llround(1e9 * stamp_s));
  return series;
}

TEST(StampDifferenceTest, IsTheLargestToTheNearest) {
  const struct {
    std::vector<double> left_s, right_s;
    double difference_s;
  } kCases[] = {
      {{0, 0.1, 0.2}, {0.003, 0.104, 0.25}, 0.050},
      {{0}, {0.02}, 0.02},
      {{0, 0.1}, {3, 4}, 2.9},         // clocks that differ
      {{0, 0.1, 0.2}, {0, 0.1}, 0.0},  // its partner is still to come
      // Otherwise a lost image looks like a skew of a period, and the advice would be to accept it.
      {{0, 0.1, 0.2, 0.3}, {0.003, 0.103, 0.303}, 0.003},
      {{0.003, 0.103, 0.303}, {0, 0.1, 0.2, 0.3}, 0.003}};
  for (const auto& [left_s, right_s, difference_s] : kCases) {
    const auto found_s = greatestStampDifference(makeSeries(left_s), makeSeries(right_s));
    ASSERT_TRUE(found_s);
    EXPECT_NEAR(*found_s, difference_s, 1e-9);
  }
  EXPECT_FALSE(std::signbit(*greatestStampDifference(makeSeries({1, 2}), makeSeries({1, 2}))));
  EXPECT_FALSE(greatestStampDifference({}, makeSeries({1})));
  EXPECT_FALSE(greatestStampDifference(makeSeries({1}), {}));
}

/// Images of both cameras, whose triggers and stamps jitter; some are lost.
class SkewTest : public testing::Test {
 protected:
  void take(double skew_s, double trigger_jitter_s, double stamp_jitter_s, double loss = 0.0) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::bernoulli_distribution lost(loss);
    left_ = right_ = {};
    for (int i = 0; i < 60; ++i) {
      const double time_s = i * kPeriod_s + trigger_jitter_s * normal(random);
      const double left_s = time_s + stamp_jitter_s * normal(random);
      const double right_s = time_s + skew_s + stamp_jitter_s * normal(random);
      if (!lost(random)) left_.add(kNow_ns + std::llround(1e9 * left_s));
      if (!lost(random)) right_.add(kNow_ns + std::llround(1e9 * right_s));
    }
  }

  StampSeries left_, right_;
};

TEST_F(SkewTest, MedianIsSigned) {
  take(0.012, 1e-3, 1e-4, 0.2);
  EXPECT_NEAR(*medianSkew(left_, right_), 0.012, 1e-4);
  EXPECT_NEAR(*medianSkew(right_, left_), -0.012, 1e-4);
  EXPECT_FALSE(medianSkew(left_, makeSeries({0, 1})));
}

TEST_F(SkewTest, ThatOfAPeriodIsToldByCommonJitter) {
  for (const double skew_s : {kPeriod_s, -kPeriod_s, 0.9 * kPeriod_s, 0.7 * kPeriod_s}) {
    for (const double loss : {0.0, 0.2}) {
      take(skew_s, 1e-3, 1e-4, loss);
      const auto found_s = skewOfAPeriod(left_, right_);
      ASSERT_TRUE(found_s) << skew_s;
      EXPECT_NEAR(*found_s, skew_s, 1e-4);
    }
  }
}

TEST_F(SkewTest, SynchronousCamerasHaveNone) {
  for (const double skew_s : {0.0, 0.005, -0.012}) {
    for (const double trigger_jitter_s : {0.0, 1e-4, 3e-3}) {
      for (const double stamp_jitter_s : {0.0, 1e-5, 1e-3, 3e-3}) {
        for (const double loss : {0.0, 0.3}) {
          take(skew_s, trigger_jitter_s, stamp_jitter_s, loss);
          EXPECT_FALSE(skewOfAPeriod(left_, right_))
              << skew_s << ' ' << trigger_jitter_s << ' ' << stamp_jitter_s << ' ' << loss;
        }
      }
    }
  }
}

TEST_F(SkewTest, ClocksThatRunApartHaveNone) {
  for (int i = 0; i < 60; ++i) {
    left_.add(kNow_ns + std::llround(1e9 * i * kPeriod_s));
    right_.add(kNow_ns + std::llround(1e9 * i * 1.001 * kPeriod_s));
  }
  EXPECT_FALSE(skewOfAPeriod(left_, right_));
}

}  // namespace
}  // namespace rotrocc
