#include "node/gyro/gyro_watch.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

/// What is told during `pairs` pairs.
std::vector<std::string> told(GyroWatch& watch, const std::string& why_not, int pairs) {
  std::vector<std::string> texts;
  for (int i = 0; i < pairs; ++i) {
    const GyroWatch::Message message = watch.onPair(why_not);
    EXPECT_EQ(message.is_warning, !message.text.empty() && !why_not.empty());
    if (!message.text.empty()) texts.push_back(message.text);
  }
  return texts;
}

TEST(GyroWatchTest, TellsOnceThatItIsUsed) {
  GyroWatch watch;
  EXPECT_EQ(told(watch, "", 100), std::vector<std::string>{"the gyroscope predicts rotations"});
}

TEST(GyroWatchTest, TellsOnceThatItIsMissingAndOnceThatItIsBack) {
  GyroWatch watch;
  told(watch, "", 10);
  EXPECT_EQ(told(watch, "no message on /imu", 100),
            std::vector<std::string>{"the gyroscope is not used: no message on /imu"});
  EXPECT_EQ(told(watch, "", 100), std::vector<std::string>{"the gyroscope predicts rotations"});
}

TEST(GyroWatchTest, SaysNothingAboutFewPairs) {
  GyroWatch watch;
  told(watch, "", 10);
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(told(watch, "late", 2).empty());
    EXPECT_TRUE(told(watch, "", 2).empty());
  }
}

TEST(GyroWatchTest, StopsWaitingAndTriesAgainNowAndThen) {
  GyroWatch watch;
  int waits = 0;
  for (int i = 0; i < 100; ++i) {
    waits += watch.waits();
    watch.onPair("late");
  }
  EXPECT_EQ(waits, GyroWatch::kPairs + 9);  // at 10, 20, ... 90
  watch.onPair("");
  EXPECT_TRUE(watch.waits());
}

}  // namespace
}  // namespace rotrocc
