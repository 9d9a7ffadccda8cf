#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace rotrocc {

/// Shows the progress of a long run on stderr: on a terminal one line with count, rate and time
/// left, redrawn at most ten times a second; otherwise (file, pipe) a line for every 10 %.
class ProgressBar {
 public:
  ProgressBar(std::string label, std::size_t total);

  /// Counts one more item.
  void advance();

  /// Shows the final count and ends the line. Call once, at the end.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void draw() const;

  std::string label_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::size_t tenths_drawn_ = 0;
  bool on_terminal_;
  Clock::time_point start_;
  Clock::time_point last_drawn_;
};

}  // namespace rotrocc
