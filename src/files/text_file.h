#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace rotrocc {

/// A line of a text file, split into words.
struct TextLine {
  std::string where;  ///< "path:12", for messages
  std::vector<std::string> words;
  bool has_commas = false;

  /// The word at `index` as a number. Throws std::runtime_error if it is not a finite number.
  double number(std::size_t index) const;

  /// The word at `index`, a time in units of `unit_ns`, in nanoseconds. Rounded; throws like
  /// number(), and on values beyond the range of 64 bit.
  std::int64_t nanoseconds(std::size_t index, std::int64_t unit_ns) const;

  /// The pose of a position [m] in the words 1 to 3 and a quaternion in the words 4 to 7, w last or
  /// first. Throws like number(), and if the quaternion has not the length 1.
  Eigen::Isometry3d quaternionPose(bool w_first) const;

  /// Throws std::runtime_error if there are fewer words than the columns of `what`.
  void requireColumns(std::size_t columns, const char* what) const;

  /// Throws std::runtime_error unless `stamp_ns`, of the first word, is later than the previous
  /// one.
  void requireLater(std::int64_t stamp_ns, std::int64_t previous_ns) const;

  [[noreturn]] void fail(const std::string& what) const;
};

/// The lines of a file except blank lines and comments that start with '#'; line ends are LF or
/// CRLF, and a byte order mark is skipped. Words are separated by white space and commas. Throws
/// std::runtime_error if the file cannot be read or no line is left.
std::vector<TextLine> readTextLines(const std::string& path);

/// Why a matrix, printed with four digits or more, is no rotation; none if it is one.
std::optional<std::string> whyNoRotation(const Eigen::Matrix3d& matrix);

}  // namespace rotrocc
