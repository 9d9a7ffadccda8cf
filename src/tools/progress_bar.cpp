#include "tools/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace rotrocc {

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), on_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::advance() {
  ++done_;
  const std::size_t parts = (on_terminal_ ? 100 : 10) * done_ / std::max<std::size_t>(total_, 1);
  if (std::exchange(parts_drawn_, parts) != parts) draw();
}

void ProgressBar::finish() {
  if (on_terminal_ || done_ < total_ || total_ == 0) draw();
  if (on_terminal_) std::fputc('\n', stderr);
}

void ProgressBar::draw() {
  const std::size_t percent = total_ > 0 ? std::min<std::size_t>(100 * done_ / total_, 100) : 100;
  const char* const format = on_terminal_ ? "\r%s %3zu %%  %zu/%zu" : "%s %3zu %%  %zu/%zu\n";
  std::fprintf(stderr, format, label_.c_str(), percent, done_, total_);
  std::fflush(stderr);
}

}  // namespace rotrocc
