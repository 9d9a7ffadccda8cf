#include "text_file.h"

#include <cmath>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace rotrocc {
namespace {

// long double, so that stamps since 1970 keep their nanoseconds where the hardware has 64 bit of
// mantissa.
long double parse(const TextLine& line, std::size_t index) {
  const std::string& word = line.words.at(index);
  std::istringstream stream(word);
  stream.imbue(std::locale::classic());  // a decimal comma of the user's locale must not matter
  long double value = 0.0L;
  if (!(stream >> value) || stream.peek() != std::istringstream::traits_type::eof()) {
    throw std::runtime_error(line.where + ": '" + word + "' is not a finite number");
  }
  return value;
}

}  // namespace

double TextLine::number(std::size_t index) const {
  const double value = static_cast<double>(parse(*this, index));
  if (!std::isfinite(value)) {
    throw std::runtime_error(where + ": '" + words[index] + "' is too large for a number");
  }
  return value;
}

std::int64_t TextLine::nanoseconds(std::size_t index) const {
  constexpr long double kMaxSeconds = 9.2e9L;
  const long double seconds = parse(*this, index);
  if (!(std::abs(seconds) < kMaxSeconds)) {
    throw std::runtime_error(where + ": '" + words[index] +
                             "' is no time in seconds: it must be below 9.2e9");
  }
  return std::llround(seconds * 1e9L);
}

std::vector<TextLine> readTextLines(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    TextLine line;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) line.words.push_back(word);  // CR is white space, too
    if (line.words.empty() || line.words.front().front() == '#') continue;
    line.where = path + ":" + std::to_string(number);
    lines.push_back(std::move(line));
  }
  if (file.bad()) throw std::runtime_error("cannot read " + path + " to its end");
  if (lines.empty()) throw std::runtime_error(path + " has no data in it");
  return lines;
}

}  // namespace rotrocc
