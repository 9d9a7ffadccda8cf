#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "stress/slow_subscriber.h"

namespace rotrocc {
namespace {

/// Enough to connect at first, and then to read on.
constexpr std::chrono::seconds kRuns(2);
constexpr std::chrono::seconds kStands(8);

}  // namespace

SlowSubscriber::SlowSubscriber()
    : process_(fork()), next_(std::chrono::steady_clock::now() + kRuns) {
  if (process_ < 0) throw std::runtime_error("cannot start " SLOW_SUBSCRIBER);
  if (process_ == 0) {
    execl(SLOW_SUBSCRIBER, SLOW_SUBSCRIBER, static_cast<char*>(nullptr));
    _exit(1);
  }
}

SlowSubscriber::~SlowSubscriber() {
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

void SlowSubscriber::poll() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  stopped_ = !stopped_;
  kill(process_, stopped_ ? SIGSTOP : SIGCONT);
  next_ = now + (stopped_ ? kStands : kRuns);
}

}  // namespace rotrocc
