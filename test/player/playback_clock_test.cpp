#include "player/playback_clock.h"

#include <algorithm>
#include <functional>
#include <future>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

using std::chrono::milliseconds;
using WallClock = std::chrono::steady_clock;

const ros::Time kBegin(1000.0);

/// What the clocks of a test publish.
class PlaybackClockTest : public ::testing::Test {
 protected:
  const std::function<void(const ros::Time&)> publish_ = [this](const ros::Time& time) {
    published_.push_back(time);
    if (published_.size() == 10) has_published_10_.set_value();
  };
  std::vector<ros::Time> published_;
  std::promise<void> has_published_10_;
};

/// How late it may be is up to the machine.
TEST_F(PlaybackClockTest, IsNeitherEarlyNorHurriesAfterADelay) {
  PlaybackClock clock(2.0, false, publish_);
  clock.start(kBegin);
  std::this_thread::sleep_for(milliseconds(100));
  const WallClock::time_point begin = WallClock::now();
  EXPECT_TRUE(clock.waitUntil(kBegin + ros::Duration(0.01)));
  EXPECT_EQ(published_.back(), kBegin + ros::Duration(0.01));
  EXPECT_TRUE(clock.waitUntil(kBegin + ros::Duration(0.11)));
  EXPECT_GE(WallClock::now() - begin, milliseconds(49));
  EXPECT_EQ(published_.back(), kBegin + ros::Duration(0.11));
}

TEST_F(PlaybackClockTest, ReportsTheTimeWhileItWaits) {
  PlaybackClock clock(1.0, false, publish_);
  clock.start(kBegin);
  auto waiting = std::async(std::launch::async,
                            [&] { return clock.waitUntil(kBegin + ros::Duration(3600.0)); });
  has_published_10_.get_future().wait();
  clock.stop();
  EXPECT_FALSE(waiting.get());
  EXPECT_TRUE(std::is_sorted(published_.begin(), published_.end()));
}

}  // namespace
}  // namespace rotrocc
