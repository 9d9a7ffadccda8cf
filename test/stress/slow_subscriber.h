#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>

namespace rotrocc {

/// Subscribes to all that the odometry publishes, in a process of its own that mostly stands still:
/// then it does not read its sockets, as a computer behind a bad network.
class SlowSubscriber {
 public:
  SlowSubscriber() {
    if (process_ < 0) throw std::runtime_error("cannot start rostopic");
    if (process_ > 0) return;
    if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(1);
    execlp("rostopic",
           "rostopic",
           "hz",
           "odom",
           "path",
           "status",
           "flow",
           "inliers",
           static_cast<char*>(nullptr));
    _exit(1);
  }
  ~SlowSubscriber() {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  SlowSubscriber(const SlowSubscriber&) = delete;
  SlowSubscriber& operator=(const SlowSubscriber&) = delete;

  /// To be called all the time: stops and continues it in turn.
  void poll() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    stopped_ = !stopped_;
    kill(process_, stopped_ ? SIGSTOP : SIGCONT);
    next_ = now + (stopped_ ? kStands : kRuns);
  }

 private:
  /// Enough to connect at first, and then to read on.
  static constexpr std::chrono::seconds kRuns{3};
  static constexpr std::chrono::seconds kStands{8};

  pid_t process_ = fork();
  bool stopped_ = false;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + kRuns;
};

}  // namespace rotrocc
