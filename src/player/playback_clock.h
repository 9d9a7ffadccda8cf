#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

#include <ros/time.h>

namespace rotrocc {

/// The time of a recording that is played: it runs from message to message, faster or slower than
/// the wall clock, and stands still during a pause. start() and waitUntil() are for the one thread
/// that plays; the other methods may be called from any.
class PlaybackClock {
 public:
  /// `rate` times as fast as recorded; 0: as fast as possible. `publish` is told the time of the
  /// recording whenever it has gone on, every 10 ms at least.
  PlaybackClock(double rate, bool paused, std::function<void(const ros::Time&)> publish);

  /// Sets the time without waiting.
  void start(const ros::Time& time);

  /// Returns when the time has come and there is no pause: at once if it is late. It is then this
  /// time, so that nothing is hurried after a delay. Returns false if it was stopped.
  bool waitUntil(const ros::Time& time);

  void setPaused(bool paused);
  bool paused() const;

  /// Ends all waiting for ever.
  void stop();
  bool stopped() const;

 private:
  using WallClock = std::chrono::steady_clock;

  /// Lets the time go on to now, but not beyond `end`. Returns whether it got there.
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
