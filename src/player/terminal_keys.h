#pragma once

#include <termios.h>

#include <chrono>
#include <optional>

namespace rotrocc {

/// Reads single keys from the terminal, without line end and without echo. Restores the terminal at
/// the end of the scope.
class TerminalKeys {
 public:
  TerminalKeys();
  ~TerminalKeys();
  TerminalKeys(const TerminalKeys&) = delete;
  TerminalKeys& operator=(const TerminalKeys&) = delete;

  /// Whether there is a terminal.
  bool available() const { return available_; }

  /// Waits for a key; returns none on timeout or without a terminal.
  std::optional<char> wait(std::chrono::milliseconds timeout);

 private:
  bool available_ = false;
  bool changed_ = false;
  termios settings_before_;
};

}  // namespace rotrocc
