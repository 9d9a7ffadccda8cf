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

/// Collects what the clock publishes.
struct Times {
  std::vector<ros::Time> times;
  std::function<void(const ros::Time&)> adder() {
    return [this](const ros::Time& time) { times.push_back(time); };
  }
};

TEST(PlaybackClock, IsNeverEarly) {
  Times published;
  PlaybackClock clock(10.0, false, published.adder());
  clock.start(kBegin);
  const WallClock::time_point begin = WallClock::now();
  EXPECT_TRUE(clock.waitUntil(kBegin + ros::Duration(1.0)));
  // How late it may be is up to the machine.
  EXPECT_GE(WallClock::now() - begin, milliseconds(99));
  EXPECT_EQ(published.times.back(), kBegin + ros::Duration(1.0));
}

TEST(PlaybackClock, TellsTheTimeWhileItWaits) {
  std::vector<ros::Time> times;
  std::promise<void> enough;
  PlaybackClock clock(1.0, false, [&](const ros::Time& time) {
    times.push_back(time);
    if (times.size() == 10) enough.set_value();
  });
  clock.start(kBegin);
  auto waiting = std::async(std::launch::async,
                            [&] { return clock.waitUntil(kBegin + ros::Duration(3600.0)); });
  enough.get_future().wait();
  clock.stop();
  EXPECT_FALSE(waiting.get());
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST(PlaybackClock, DoesNotWaitAtRateZero) {
  Times published;
  PlaybackClock clock(0.0, false, published.adder());
  clock.start(kBegin);
  EXPECT_TRUE(clock.waitUntil(kBegin + ros::Duration(1e6)));
  EXPECT_EQ(published.times.back(), kBegin + ros::Duration(1e6));
}

TEST(PlaybackClock, DoesNotHurryAfterADelay) {
  Times published;
  PlaybackClock clock(1.0, false, published.adder());
  clock.start(kBegin);
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_TRUE(clock.waitUntil(kBegin + ros::Duration(0.01)));
  EXPECT_EQ(published.times.back(), kBegin + ros::Duration(0.01));
  const WallClock::time_point begin = WallClock::now();
  EXPECT_TRUE(clock.waitUntil(kBegin + ros::Duration(0.06)));
  EXPECT_GE(WallClock::now() - begin, milliseconds(49));
}

TEST(PlaybackClock, StandsStillDuringAPause) {
  Times published;
  PlaybackClock clock(1.0, true, published.adder());
  clock.start(kBegin);
  auto waiting =
      std::async(std::launch::async, [&] { return clock.waitUntil(kBegin + ros::Duration(0.01)); });
  EXPECT_EQ(waiting.wait_for(milliseconds(100)), std::future_status::timeout);
  EXPECT_TRUE(clock.paused());
  clock.setPaused(false);
  EXPECT_TRUE(waiting.get());
}

TEST(PlaybackClock, StopEndsAPause) {
  Times published;
  PlaybackClock clock(1.0, true, published.adder());
  clock.start(kBegin);
  auto waiting = std::async(std::launch::async, [&] { return clock.waitUntil(kBegin); });
  clock.stop();
  EXPECT_FALSE(waiting.get());
  EXPECT_TRUE(clock.stopped());
}

}  // namespace
}  // namespace rotrocc
