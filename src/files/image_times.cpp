#include "files/image_times.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <string>

#include <opencv2/core.hpp>

#include "common/median.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {
namespace {

/// From 1980, where GPS begins to count, to 2106, where ROS ends.
constexpr double kEarliest_s = 3e8;
constexpr double kLatest_s = 4.3e9;

/// Periods of cameras: a step of one unit more or less is none.
constexpr double kShortestPeriod_s = 5e-4;
constexpr double kLongestPeriod_s = 10.0;

const struct {
  std::int64_t ns;
  const char* name;
} kUnits[] = {{kSecond_ns, "s"}, {1'000'000, "ms"}, {1'000, "us"}, {1, "ns"}};

/// Median step [s]; 0 if there is none.
double periodOf(std::vector<std::int64_t> stamps_ns) {
  std::sort(stamps_ns.begin(), stamps_ns.end());
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    steps_s.push_back(1e-9 * static_cast<double>(stamps_ns[i] - stamps_ns[i - 1]));
  }
  return steps_s.empty() ? 0.0 : median(steps_s);
}

bool isOfCamera(double period_s) {
  return period_s == 0.0 || (period_s >= kShortestPeriod_s && period_s <= kLongestPeriod_s);
}

[[noreturn]] void reject(const TextLine& line, double period_s, std::int64_t unit_ns) {
  const auto* const read = std::find_if(
      std::begin(kUnits), std::end(kUnits), [&](const auto& unit) { return unit.ns == unit_ns; });
  std::string remedy = "check them, or give the times in times.txt";
  for (const auto& unit : kUnits) {
    const double other_s = period_s * static_cast<double>(unit.ns) / static_cast<double>(unit_ns);
    if (!isOfCamera(other_s)) continue;
    remedy =
        cv::format("they look like times in %s, with %.3g s from one to the next: convert them",
                   unit.name,
                   other_s) +
        " to " + read->name;
  }
  line.fail("by their times in " + std::string(read->name) +
            cv::format(", images are %.3g s apart, which is not the rate of a camera: ", period_s) +
            remedy);
}

/// Of "2011-09-26 13:02:25.594360375", as in KITTI's raw drives.
std::string secondsOfDate(const TextLine& line) {
  std::tm date = {};
  const std::string& time = line.words[1];
  const std::size_t dot = std::min(time.find('.'), time.size());
  std::istringstream text(line.words[0] + " " + time.substr(0, dot));
  if (dot < 8 || !(text >> std::get_time(&date, "%Y-%m-%d %H:%M:%S"))) {
    line.fail("is not a time: a number or YYYY-MM-DD HH:MM:SS is expected");
  }
  return std::to_string(timegm(&date)) + time.substr(dot);
}

}  // namespace

std::int64_t timeUnit_ns(double time, std::int64_t otherwise) {
  for (const auto& unit : kUnits) {
    const double seconds = 1e-9 * static_cast<double>(unit.ns) * time;
    if (seconds >= kEarliest_s && seconds <= kLatest_s) return unit.ns;
  }
  return otherwise;
}

std::int64_t timeUnit_ns(const std::vector<TextLine>& lines, std::int64_t otherwise) {
  const std::int64_t first = timeUnit_ns(lines.front().number(0), otherwise);
  return first == timeUnit_ns(lines.back().number(0), otherwise) ? first : otherwise;
}

std::vector<std::int64_t> imageStamps(const std::vector<TextLine>& lines, std::int64_t unit_ns) {
  const auto stampsIn = [&](std::int64_t unit) {
    std::vector<std::int64_t> stamps_ns;
    for (const TextLine& line : lines) stamps_ns.push_back(line.nanoseconds(0, unit));
    return stamps_ns;
  };
  const std::int64_t by_digits_ns = timeUnit_ns(lines, unit_ns);
  // As nanoseconds since a start some days ago, which may have the digits of microseconds.
  for (const std::int64_t unit : {by_digits_ns, unit_ns}) {
    const std::vector<std::int64_t> stamps_ns = stampsIn(unit);
    if (isOfCamera(periodOf(stamps_ns))) return stamps_ns;
  }
  reject(lines.front(), periodOf(stampsIn(by_digits_ns)), by_digits_ns);
}

std::vector<std::int64_t> readTimes(const std::string& path) {
  std::vector<TextLine> lines = readTextLines(path);
  for (TextLine& line : lines) {
    if (line.words.size() == 2) line.words = {secondsOfDate(line)};
    if (line.words.size() == 1) continue;
    line.fail(cv::format("%zu words, but one time per line is expected", line.words.size()));
  }
  const std::vector<std::int64_t> stamps_ns = imageStamps(lines, kSecond_ns);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    lines[i].requireLater(stamps_ns[i], stamps_ns[i - 1]);
  }
  return stamps_ns;
}

}  // namespace rotrocc
