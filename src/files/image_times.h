#pragma once

#include <cstdint>
#include <vector>

#include "files/text_file.h"

namespace rotrocc {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// The unit [ns] of a time since 1970, which is seconds, or one of their thousandth parts as the
/// number of digits says; `otherwise` if it does not count from 1970.
std::int64_t timeUnit_ns(double time, std::int64_t otherwise);

/// The same for the first words of lines; `otherwise` unless the first and the last one agree.
std::int64_t timeUnit_ns(const std::vector<TextLine>& lines, std::int64_t otherwise);

/// Stamps [ns] of images from their times, the first word of each line, in the order of the lines.
/// Times that do not count from 1970 are in units of `unit_ns`. Throws std::runtime_error with
/// file, value and remedy if a word is no time, and if images so far apart are of no camera.
std::vector<std::int64_t> imageStamps(const std::vector<TextLine>& lines, std::int64_t unit_ns);

}  // namespace rotrocc
