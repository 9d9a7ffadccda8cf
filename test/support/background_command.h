#pragma once

#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <stdexcept>
#include <string>

namespace rotrocc {

/// A command of the shell that runs until it is interrupted, as with Ctrl-C, or killed.
class BackgroundCommand {
 public:
  /// Its output goes to the file `log`.
  BackgroundCommand(const std::string& command, const std::string& log) : process_(fork()) {
    if (process_ < 0) throw std::runtime_error("cannot run " + command);
    setpgid(process_, process_);  // by both, as either may be first
    if (process_ > 0) return;
    prctl(PR_SET_PDEATHSIG, SIGINT);  // a test that is killed leaves nothing behind
    signal(SIGINT, SIG_DFL);          // ignored if the test runs in the background of a shell
    execl("/bin/sh", "sh", "-c", ("exec " + command + " >" + log + " 2>&1").c_str(), nullptr);
    _exit(127);
  }
  ~BackgroundCommand() { interrupt(); }
  BackgroundCommand(const BackgroundCommand&) = delete;
  BackgroundCommand& operator=(const BackgroundCommand&) = delete;

  /// The exit status if the command has ended by itself; -1 if a signal ended it.
  std::optional<int> status() {
    int status = 0;
    if (process_ > 0 && waitpid(process_, &status, WNOHANG) == process_) {
      process_ = 0;
      status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    return status_;
  }

  /// Sends a signal to the command with the processes that it has started, and waits for its end.
  /// Sends it again, as a user does: a Python program that is still starting may not take it.
  void interrupt(int signal = SIGINT) {
    if (process_ <= 0) return;
    constexpr int kAgain = 100;  // periods of waiting
    for (int periods = 0; waitpid(process_, nullptr, WNOHANG) == 0; ++periods) {
      if (periods % kAgain == 0) kill(-process_, signal);
      usleep(100'000);
    }
    process_ = 0;
  }

 private:
  pid_t process_;
  std::optional<int> status_;
};

}  // namespace rotrocc
