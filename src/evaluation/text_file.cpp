#include "evaluation/text_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace rotrocc {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  const std::string separators = std::string(" \t\r\n\v\f") + separator;
  std::vector<std::string> words;
  std::size_t begin = text.find_first_not_of(separators);
  while (begin != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return words;
}

std::istringstream makeStream() {
  std::istringstream stream;
  stream.imbue(std::locale::classic());  // independent of the decimal comma of the locale
  return stream;
}

// long double, so that stamps since 1970 keep their nanoseconds if it has a 64-bit mantissa.
long double parse(const TextLine& line, std::size_t index) {
  thread_local std::istringstream stream = makeStream();  // construction takes longer than parsing
  const std::string& word = line.words.at(index);
  stream.clear();
  stream.str(word);
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
                             "' is not a time in seconds below 9.2e9");
  }
  return std::llround(seconds * 1e9L);
}

std::int64_t TextLine::integer(std::size_t index) const {
  constexpr long double kMax = 9.2e18L;
  const long double value = parse(*this, index);
  if (!(std::abs(value) < kMax)) {
    throw std::runtime_error(where + ": '" + words[index] + "' is not an integer below 9.2e18");
  }
  return std::llround(value);
}

std::vector<TextLine> readTextLines(const std::string& path, char separator) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    TextLine line;
    line.words = split(text, separator);  // CR counts as white space
    if (line.words.empty() || line.words.front().front() == '#') continue;
    line.where = path + ":" + std::to_string(number);
    lines.push_back(std::move(line));
  }
  if (file.bad()) throw std::runtime_error("cannot read " + path + " to its end");
  if (lines.empty()) throw std::runtime_error(path + " has no data");
  return lines;
}

}  // namespace rotrocc
