#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>

namespace rotrocc {

/// Shows the progress of a long run on stderr: on a terminal in one line, for each percent;
/// otherwise (file, pipe) by a line for every 10 %.
class ProgressBar {
 public:
  ProgressBar(std::string label, std::size_t total) : label_(std::move(label)), total_(total) {}

  /// Counts one more item.
  void advance() {
    ++done_;
    const std::size_t parts = (on_terminal_ ? 100 : 10) * done_ / std::max<std::size_t>(total_, 1);
    if (std::exchange(parts_drawn_, parts) != parts) draw();
  }

  /// Shows the final count and ends the line. Call once, at the end.
  void finish() const {
    if (on_terminal_ || done_ < total_ || total_ == 0) draw();
    if (on_terminal_) std::fputc('\n', stderr);
  }

 private:
  void draw() const {
    const std::size_t percent = total_ > 0 ? std::min<std::size_t>(100 * done_ / total_, 100) : 100;
    const char* const format = on_terminal_ ? "\r%s %3zu %%  %zu/%zu" : "%s %3zu %%  %zu/%zu\n";
    std::fprintf(stderr, format, label_.c_str(), percent, done_, total_);
    std::fflush(stderr);
  }

  std::string label_;
  std::size_t total_;
  bool on_terminal_ = isatty(STDERR_FILENO) == 1;
  std::size_t done_ = 0;
  std::size_t parts_drawn_ = 0;
};

}  // namespace rotrocc
