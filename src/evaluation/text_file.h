#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rotrocc {

/// A line of a text file, split into words.
struct TextLine {
  std::string where;  ///< "path:12", for messages
  std::vector<std::string> words;

  /// The word at `index` as a number. Throws std::runtime_error if it is not a finite number.
  double number(std::size_t index) const;

  /// The word at `index`, a time [s], in nanoseconds, rounded. Throws like number(), and on times
  /// beyond the range of 64 bit.
  std::int64_t nanoseconds(std::size_t index) const;

  /// The word at `index` as an integer, rounded. Throws like number(), and on values beyond the
  /// range of 64 bit.
  std::int64_t integer(std::size_t index) const;

  /// Throws std::runtime_error with `where` and what is wrong there.
  [[noreturn]] void fail(const std::string& what) const;
};

/// The lines of a file except blank lines and comments that start with '#'; line ends are LF or
/// CRLF. Words are separated by white space, and by `separator`. Throws std::runtime_error if the
/// file cannot be read or no line is left.
std::vector<TextLine> readTextLines(const std::string& path, char separator = ' ');

}  // namespace rotrocc
