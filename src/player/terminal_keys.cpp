#include "player/terminal_keys.h"

#include <poll.h>
#include <unistd.h>

#include <thread>

namespace rotrocc {

TerminalKeys::TerminalKeys() {
  // Only the process in the foreground may change the terminal.
  available_ =
      tcgetpgrp(STDIN_FILENO) == getpgrp() && tcgetattr(STDIN_FILENO, &settings_before_) == 0;
  if (!available_) return;
  termios settings = settings_before_;
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  changed_ = tcsetattr(STDIN_FILENO, TCSANOW, &settings) == 0;
}

TerminalKeys::~TerminalKeys() {
  if (changed_) tcsetattr(STDIN_FILENO, TCSANOW, &settings_before_);
}

std::optional<char> TerminalKeys::wait(std::chrono::milliseconds timeout) {
  if (!available_) {
    std::this_thread::sleep_for(timeout);
    return std::nullopt;
  }
  pollfd input = {STDIN_FILENO, POLLIN, 0};
  if (poll(&input, 1, static_cast<int>(timeout.count())) <= 0) return std::nullopt;
  char key = 0;
  if (read(STDIN_FILENO, &key, 1) != 1) {
    available_ = false;  // the terminal was closed
    return std::nullopt;
  }
  return key;
}

}  // namespace rotrocc
