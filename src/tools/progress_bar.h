#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace rotrocc {

/// Shows on stderr how far a long run is: on a terminal one line that is drawn anew, at most ten
/// times a second, with count, rate and time left; elsewhere (a file, a pipe) a line for every 10
/// %.
class ProgressBar {
 public:
  ProgressBar(std::string label, std::size_t total);

  /// One more is done.
  void advance();

  /// Shows the final count and ends the line, so that others can print. To be called once, at the
  /// end.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void draw() const;

  std::string label_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::size_t tenths_shown_ = 0;
  bool on_terminal_;
  Clock::time_point start_;
  Clock::time_point last_drawn_;
};

}  // namespace rotrocc
