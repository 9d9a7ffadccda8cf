#include "node/gyro/gyro_watch.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// How often the log tells of it during `pairs` pairs.
int told(GyroWatch& watch, bool used, int pairs) {
  int count = 0;
  for (int i = 0; i < pairs; ++i) count += watch.tellsOf(used);
  return count;
}

TEST(GyroWatchTest, TellsOfEachChangeOnce) {
  GyroWatch watch;
  EXPECT_EQ(told(watch, true, GyroWatch::kPairs - 1), 0);
  EXPECT_EQ(told(watch, true, 100), 1);
  EXPECT_EQ(told(watch, false, 100), 1);
  EXPECT_EQ(told(watch, true, 100), 1);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(told(watch, false, 2), 0) << "few pairs";
    EXPECT_EQ(told(watch, true, 2), 0);
  }
}

TEST(GyroWatchTest, StopsWaitingAndTriesAgainNowAndThen) {
  GyroWatch watch;
  int waits = 0;
  for (int i = 0; i < 100; ++i) {
    waits += watch.waits();
    watch.tellsOf(false);
  }
  EXPECT_EQ(waits, GyroWatch::kPairs + 9);  // at 10, 20, ... 90
  watch.tellsOf(true);
  EXPECT_TRUE(watch.waits());
}

}  // namespace
}  // namespace rotrocc
