#include "player/playback_clock.h"

#include <algorithm>
#include <utility>

namespace rotrocc {
namespace {

constexpr std::chrono::milliseconds kTick(10);

}  // namespace

PlaybackClock::PlaybackClock(double rate,
                             bool paused,
                             std::function<void(const ros::Time&)> publish)
    : rate_(rate), publish_(std::move(publish)), paused_(paused) {}

void PlaybackClock::start(const ros::Time& time) {
  now_ = time;
  last_tick_ = WallClock::now();
  publish_(now_);
}

bool PlaybackClock::waitUntil(const ros::Time& time) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_) {
    if (paused_) {
      changed_.wait(lock);
      last_tick_ = WallClock::now();
    } else if (!advance(time)) {
      const auto left = std::chrono::duration<double>((time - now_).toSec() / rate_);
      changed_.wait_for(lock, std::min<std::chrono::duration<double>>(left, kTick));
    } else {
      return true;
    }
  }
  return false;
}

bool PlaybackClock::advance(const ros::Time& end) {
  const WallClock::time_point tick = WallClock::now();
  const double passed_s = rate_ * std::chrono::duration<double>(tick - last_tick_).count();
  last_tick_ = tick;
  const bool arrived = rate_ == 0.0 || now_ + ros::Duration(passed_s) >= end;
  now_ = arrived ? std::max(now_, end) : now_ + ros::Duration(passed_s);
  publish_(now_);
  return arrived;
}

void PlaybackClock::setPaused(bool paused) {
  std::lock_guard<std::mutex> lock(mutex_);
  paused_ = paused;
  changed_.notify_all();
}

void PlaybackClock::stop() {
  std::lock_guard<std::mutex> lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

bool PlaybackClock::stopped() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return stopped_;
}

}  // namespace rotrocc
