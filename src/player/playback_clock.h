#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

#include <ros/time.h>

namespace rotrocc {

/// Time of a recording during playback: advances from message to message, at `rate` times the wall
/// clock, and stops during a pause. Call start() and waitUntil() only from the playing thread; the
/// other methods are thread-safe.
class PlaybackClock {
 public:
  /// `rate` times as fast as recorded; 0: as fast as possible. `publish` gets the time of the
  /// recording whenever it advances, at least every 10 ms.
  PlaybackClock(double rate, bool paused, std::function<void(const ros::Time&)> publish);

  void start(const ros::Time& time);

  /// Waits for the time, and for the end of a pause. Returns immediately if late, and sets the
  /// clock to this time, so that playback does not catch up after a delay. Returns false if
  /// stopped.
  bool waitUntil(const ros::Time& time);

  void setPaused(bool paused);

  /// Ends all current and future waits.
  void stop();
  bool stopped() const;

 private:
  using WallClock = std::chrono::steady_clock;

  /// Advances the time to now, at most to `end`. Returns whether it reached `end`.
  bool advance(const ros::Time& end);

  const double rate_;
  const std::function<void(const ros::Time&)> publish_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_;
  bool stopped_ = false;
  ros::Time now_;
  WallClock::time_point last_tick_;
};

}  // namespace rotrocc
