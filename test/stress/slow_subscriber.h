#pragma once

#include <sys/types.h>

#include <chrono>

namespace rotrocc {

/// The program slow_subscriber, in a process of its own, which mostly stands still.
class SlowSubscriber {
 public:
  SlowSubscriber();
  ~SlowSubscriber();
  SlowSubscriber(const SlowSubscriber&) = delete;
  SlowSubscriber& operator=(const SlowSubscriber&) = delete;

  /// To be called all the time: stops and continues it in turn.
  void poll();

 private:
  pid_t process_;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace rotrocc
