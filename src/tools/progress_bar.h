#pragma once

#include <cstddef>
#include <string>

namespace rotrocc {

/// Shows the progress of a long run on stderr: on a terminal in one line, for each percent;
/// otherwise (file, pipe) by a line for every 10 %.
class ProgressBar {
 public:
  ProgressBar(std::string label, std::size_t total);

  /// Counts one more item.
  void advance();

  /// Shows the final count and ends the line. Call once, at the end.
  void finish();

 private:
  void draw();

  std::string label_;
  std::size_t total_;
  bool on_terminal_;
  std::size_t done_ = 0;
  std::size_t parts_drawn_ = 0;
};

}  // namespace rotrocc
