#include "input/clock_watch.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

using std::chrono::seconds;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

TEST(ClockWatchTest, StandsStillFromTheSecondSecondOn) {
  ClockWatch watch;
  const ClockWatch::Time start;
  EXPECT_FALSE(watch.standsStill(0, start - seconds(100)));
  EXPECT_FALSE(watch.standsStill(0, start)) << "no clock is no standstill";
  for (int i = 1; i <= 10; ++i) EXPECT_FALSE(watch.standsStill(i * kSecond_ns, start + seconds(i)));
  EXPECT_FALSE(watch.standsStill(10 * kSecond_ns, start + seconds(11)));
  EXPECT_TRUE(watch.standsStill(10 * kSecond_ns, start + seconds(12)));
  EXPECT_TRUE(watch.standsStill(10 * kSecond_ns, start + seconds(100)));
  EXPECT_FALSE(watch.standsStill(11 * kSecond_ns, start + seconds(101)));
}

}  // namespace
}  // namespace rotrocc
