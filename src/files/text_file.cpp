#include "files/text_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>
#include <stdexcept>

#include <opencv2/core.hpp>

namespace rotrocc {
namespace {

constexpr double kMaxRoundingError = 1e-3;  // of four digits

std::istringstream makeStream() {
  std::istringstream stream;
  stream.imbue(std::locale::classic());  // independent of the decimal comma of the locale
  return stream;
}

[[noreturn]] void reject(const TextLine& line, std::size_t index, const char* why) {
  line.fail("'" + line.words[index] + "' is " + why);
}

// long double, so that stamps since 1970 keep their nanoseconds if it has a 64-bit mantissa.
long double parse(const TextLine& line, std::size_t index) {
  thread_local std::istringstream stream = makeStream();  // construction takes longer than parsing
  stream.clear();
  stream.str(line.words.at(index));
  long double value = 0.0L;
  if (!(stream >> value) || stream.peek() != std::istringstream::traits_type::eof()) {
    reject(line, index, "not a finite number");
  }
  return value;
}

}  // namespace

double TextLine::number(std::size_t index) const {
  const double value = static_cast<double>(parse(*this, index));
  if (!std::isfinite(value)) reject(*this, index, "too large for a number");
  return value;
}

std::int64_t TextLine::nanoseconds(std::size_t index, std::int64_t unit_ns) const {
  const long double time_ns = parse(*this, index) * static_cast<long double>(unit_ns);
  if (!(std::abs(time_ns) < 9.2e18L)) {
    reject(*this,
           index,
           unit_ns == 1 ? "not an integer below 9.2e18" : "not a time in seconds below 9.2e9");
  }
  return std::llround(time_ns);
}

Eigen::Isometry3d TextLine::quaternionPose(bool w_first) const {
  const std::size_t x = w_first ? 5 : 4;
  const Eigen::Quaterniond quaternion(
      number(w_first ? 4 : 7), number(x), number(x + 1), number(x + 2));
  if (!(std::abs(quaternion.norm() - 1.0) < 10.0 * kMaxRoundingError)) {
    fail(cv::format("the quaternion has the length %.3f instead of 1", quaternion.norm()));
  }
  Eigen::Isometry3d pose(quaternion.normalized());
  pose.translation() = Eigen::Vector3d(number(1), number(2), number(3));
  return pose;
}

void TextLine::requireColumns(std::size_t columns, const char* what) const {
  if (words.size() >= columns) return;
  fail(cv::format("%zu columns: %s are expected, separated by commas", words.size(), what));
}

void TextLine::requireLater(std::int64_t stamp_ns, std::int64_t previous_ns) const {
  if (stamp_ns > previous_ns) return;
  fail("the time " + words.front() + " is not later than the previous one: sort the file by time");
}

void TextLine::fail(const std::string& what) const {
  throw std::runtime_error(where + ": " + what);
}

std::vector<TextLine> readTextLines(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::vector<TextLine> lines;
  std::istringstream stream = makeStream();
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    if (number == 1 && text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
    const bool has_commas = text.find(',') != std::string::npos;
    std::replace(text.begin(), text.end(), ',', ' ');
    stream.clear();
    stream.str(text);
    using Words = std::istream_iterator<std::string>;  // CR counts as white space
    TextLine line = {path + ":" + std::to_string(number), {Words(stream), Words()}, has_commas};
    if (line.words.empty() || line.words.front().front() == '#') continue;
    lines.push_back(std::move(line));
  }
  if (file.bad()) throw std::runtime_error("cannot read " + path + " to its end");
  if (lines.empty()) throw std::runtime_error(path + " has no data");
  return lines;
}

std::optional<std::string> whyNoRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d deviation = matrix * matrix.transpose() - Eigen::Matrix3d::Identity();
  const double error = deviation.cwiseAbs().maxCoeff();
  if (!(error <= kMaxRoundingError)) return cv::format("off orthonormality by %.2g", error);
  if (matrix.determinant() < 0.0) return "a reflection";
  return std::nullopt;
}

}  // namespace rotrocc
