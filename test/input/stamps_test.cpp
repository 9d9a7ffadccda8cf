#include "input/stamps.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

constexpr std::int64_t kPeriod_ns = 33'333'333;
constexpr double kPeriod_s = 1e-9 * kPeriod_ns;

Stamps fromMs(const std::vector<double>& stamps_ms) {
  Stamps stamps_ns;
  for (const double stamp_ms : stamps_ms) {
    stamps_ns.push_back(1'600'000'000'000'000'000 + std::llround(1e6 * stamp_ms));
  }
  return stamps_ns;
}

TEST(StampsTest, PeriodIsThatOfMostImages) {
  EXPECT_FALSE(periodOf({}));
  EXPECT_FALSE(periodOf({7}));
  EXPECT_FALSE(periodOf({7, 7, 3}));
  EXPECT_EQ(periodOf({0, 10, 20, 5, 15}), 10) << "a jump back is no step";
  std::mt19937 random(3);
  std::bernoulli_distribution lost(0.5);
  std::normal_distribution<double> jitter_ns(0.0, 3e6);
  Stamps exact, jittered;
  for (int i = 0; i < 200; ++i) {
    const std::int64_t stamp_ns = i * kPeriod_ns + (i > 100 ? 3'000'000'000 : 0);
    if (!lost(random)) exact.push_back(stamp_ns);
    jittered.push_back(stamp_ns + std::llround(jitter_ns(random)));
  }
  EXPECT_EQ(periodOf(exact), kPeriod_ns);
  // The median of 200 steps, whose deviation is 4.2 ms, varies by 0.4 ms.
  EXPECT_NEAR(static_cast<double>(*periodOf(jittered)), kPeriod_ns, 1.2e6);
}

TEST(StampsTest, MatchesTheNearest) {
  using Indices = std::vector<std::pair<std::size_t, std::size_t>>;
  const struct {
    const char* what;
    std::vector<double> left_ms, right_ms;
    Indices matches;
  } rows[] = {
      {"the nearest", {0, 50, 100}, {1, 49, 98}, {{0, 0}, {1, 1}, {2, 2}}},
      {"the tolerance is inclusive", {0, 50}, {4, 54.001}, {{0, 0}}},
      {"lost images do not shift the others",
       {0, 50, 150, 200},
       {0, 100, 150, 200, 250},
       {{0, 0}, {2, 2}, {3, 3}}},
      {"each has one partner, the nearer one", {0, 4, 100}, {3}, {{1, 0}}},
      {"no images", {}, {3}, {}},
  };
  for (const auto& [what, left_ms, right_ms, matches] : rows) {
    EXPECT_EQ(matchStamps(fromMs(left_ms), fromMs(right_ms), 4'000'000), matches) << what;
  }
}

TEST(StampsTest, LargestSkewIsToTheNearest) {
  const struct {
    std::vector<double> left_ms, right_ms;
    double largest_ms;
  } rows[] = {
      {{0, 100, 200}, {3, 104, 250}, 50},
      {{0}, {20}, 20},
      {{0, 100}, {3000, 4000}, 2900},  // clocks that differ
      {{0, 100, 200}, {0, 100}, 0},    // its partner is still to come
      // Otherwise a lost image looks like a skew of a period, and the advice would be to accept it.
      {{0, 100, 200, 300}, {3, 103, 303}, 3},
      {{3, 103, 303}, {0, 100, 200, 300}, 3}};
  for (const auto& [left_ms, right_ms, largest_ms] : rows) {
    const Stamps left_ns = fromMs(left_ms);
    const auto skew = skewOf(left_ns, fromMs(right_ms), periodOf(left_ns));
    ASSERT_TRUE(skew);
    EXPECT_NEAR(skew->largest_s, 1e-3 * largest_ms, 1e-9);
    EXPECT_FALSE(skew->median_s || skew->of_a_period_s) << "too few";
  }
  EXPECT_FALSE(skewOf({}, {1}, {}));
  EXPECT_FALSE(skewOf({1}, {}, {}));
}

/// Of cameras whose triggers and stamps jitter; some images are lost.
StampSkew jittering(double skew_s, double trigger_jitter_s, double stamp_jitter_s, double loss) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::bernoulli_distribution lost(loss);
  std::vector<double> left_ms, right_ms;
  for (int i = 0; i < 32; ++i) {
    const double time_s = i * kPeriod_s + trigger_jitter_s * normal(random);
    const double left_s = time_s + stamp_jitter_s * normal(random);
    const double right_s = time_s + skew_s + stamp_jitter_s * normal(random);
    if (!lost(random)) left_ms.push_back(1e3 * left_s);
    if (!lost(random)) right_ms.push_back(1e3 * right_s);
  }
  return *skewOf(fromMs(left_ms), fromMs(right_ms), kPeriod_ns);
}

TEST(StampsTest, SkewOfAPeriodIsReportedByCommonJitter) {
  for (const double skew_s : {kPeriod_s, -kPeriod_s, 0.9 * kPeriod_s, 0.7 * kPeriod_s}) {
    for (const double loss : {0.0, 0.1}) {
      const auto found_s = jittering(skew_s, 1e-3, 1e-4, loss).of_a_period_s;
      ASSERT_TRUE(found_s) << skew_s << ' ' << loss;
      EXPECT_NEAR(*found_s, skew_s, 1e-4);
    }
  }
}

TEST(StampsTest, SynchronousCamerasHaveNoSkewOfAPeriod) {
  for (const double skew_s : {0.0, 0.005, -0.012}) {
    for (const double trigger_jitter_s : {0.0, 1e-4, 3e-3}) {
      for (const double stamp_jitter_s : {0.0, 1e-5, 1e-3, 3e-3}) {
        for (const double loss : {0.0, 0.2}) {
          const StampSkew skew = jittering(skew_s, trigger_jitter_s, stamp_jitter_s, loss);
          EXPECT_FALSE(skew.of_a_period_s)
              << skew_s << ' ' << trigger_jitter_s << ' ' << stamp_jitter_s << ' ' << loss;
          EXPECT_TRUE(loss > 0.0 || skew.median_s);
          EXPECT_NEAR(skew.median_s.value_or(skew_s), skew_s, 1e-4 + 2.0 * stamp_jitter_s);
        }
      }
    }
  }
  Stamps left_ns, slower_ns;
  for (int i = 0; i < 32; ++i) {
    left_ns.push_back(i * kPeriod_ns);
    slower_ns.push_back(i * (kPeriod_ns + kPeriod_ns / 1000));
  }
  EXPECT_FALSE(skewOf(left_ns, slower_ns, kPeriod_ns)->of_a_period_s) << "clocks that run apart";
}

}  // namespace
}  // namespace rotrocc
