#pragma once

#include <termios.h>

#include <chrono>
#include <optional>

namespace rotrocc {

/// Keys as they are pressed on the terminal of the program, without a line end and without echo.
/// The terminal is as before at the end of the scope.
class TerminalKeys {
 public:
  TerminalKeys();
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// Whether there is a terminal.
  bool available() const { return available_; }

  /// Waits for a key; none if none is pressed in time, or there is no terminal.
  std::optional<char> wait(std::chrono::milliseconds timeout);

 private:
  bool available_ = false;
  bool changed_ = false;
  termios settings_before_;
};

}  // namespace rotrocc
