#include "tools/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace rotrocc {
namespace {

constexpr std::size_t kWidth = 30;
constexpr std::chrono::milliseconds kRedrawPeriod(100);

}  // namespace

ProgressBar::ProgressBar(std::string label, std::size_t total)
    : label_(std::move(label)),
      total_(total),
      on_terminal_(isatty(STDERR_FILENO) == 1),
      start_(Clock::now()) {}

void ProgressBar::advance() {
  ++done_;
  const auto now = Clock::now();
  const std::size_t tenths = total_ > 0 ? 10 * done_ / total_ : 0;
  if (on_terminal_ ? now - last_drawn_ < kRedrawPeriod : tenths == tenths_drawn_) return;
  last_drawn_ = now;
  tenths_drawn_ = tenths;
  draw();
}

void ProgressBar::finish() {
  if (on_terminal_ || tenths_drawn_ < 10) draw();
  if (on_terminal_) std::fputc('\n', stderr);
}

void ProgressBar::draw() const {
  const double share =
      total_ > 0 ? std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_)) : 1.0;
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  const double rate = static_cast<double>(done_) / std::max(1e-3, elapsed.count());
  const std::size_t remaining = total_ - std::min(done_, total_);
  const auto left_s = static_cast<long>(rate > 0.0 ? static_cast<double>(remaining) / rate : 0.0);
  if (on_terminal_) {
    const auto filled = static_cast<std::size_t>(share * static_cast<double>(kWidth));
    const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
    std::fprintf(stderr, "\r%s [%s]", label_.c_str(), bar.c_str());
  } else {
    std::fprintf(stderr, "%s %3.0f %%", label_.c_str(), 100.0 * share);
  }
  // \033[K clears the rest of a longer line.
  std::fprintf(stderr,
               "  %zu/%zu  %.1f/s  %ld:%02ld left%s",
               done_,
               total_,
               rate,
               left_s / 60,
               left_s % 60,
               on_terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

}  // namespace rotrocc
