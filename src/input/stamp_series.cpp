#include "input/stamp_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "common/to_seconds.h"

namespace rotrocc {
namespace {

constexpr std::size_t kEnough = 16;
/// Spread of the differences of neighbours: more than that of clocks that are synchronized well ...
constexpr double kLeastJitter_s = 2e-4;
/// ... and times that of images of the same time, beyond chance.
constexpr double kClearlyMore = 4.0;

/// Nearest stamp minus `stamp_ns`; there must be a stamp.
std::int64_t toNearest(std::int64_t stamp_ns, const StampSeries& series) {
  const auto& stamps_ns = series.stamps_ns();
  return *std::min_element(stamps_ns.begin(), stamps_ns.end(), [&](std::int64_t a, std::int64_t b) {
    return std::abs(a - stamp_ns) < std::abs(b - stamp_ns);
  }) - stamp_ns;
}

/// Right minus left stamps that are `periods` apart, give or take half a period; sorted.
std::vector<double> skewsNear(int periods, const StampSeries& left, const StampSeries& right) {
  std::vector<double> skews_s;
  const auto period_ns = commonPeriod_ns(left, right);
  if (!period_ns || right.stamps_ns().empty()) return skews_s;
  for (const std::int64_t stamp_ns : left.stamps_ns()) {
    const std::int64_t shift_ns = periods * *period_ns;
    const std::int64_t rest_ns = toNearest(stamp_ns + shift_ns, right);
    if (2 * std::abs(rest_ns) <= *period_ns) skews_s.push_back(toSeconds(shift_ns + rest_ns));
  }
  std::sort(skews_s.begin(), skews_s.end());
  return skews_s;
}

/// Half of the values are within so much.
double spread(const std::vector<double>& sorted) {
  return sorted[sorted.size() * 3 / 4] - sorted[sorted.size() / 4];
}

}  // namespace

void StampSeries::add(std::int64_t stamp_ns) {
  stamps_ns_.push_back(stamp_ns);
  if (stamps_ns_.size() > kLength) stamps_ns_.pop_front();
  std::array<std::int64_t, kLength> steps_ns;
  std::size_t count = 0;
  for (std::size_t i = 1; i < stamps_ns_.size(); ++i) {
    const std::int64_t step_ns = stamps_ns_[i] - stamps_ns_[i - 1];
    if (step_ns > 0) steps_ns[count++] = step_ns;
  }
  if (count == 0) return;
  const auto quartile = steps_ns.begin() + (count - 1) / 4;
  std::nth_element(steps_ns.begin(), quartile, steps_ns.begin() + count);
  period_ns_ = *quartile;
}

std::optional<std::int64_t> commonPeriod_ns(const StampSeries& left, const StampSeries& right) {
  if (!left.period_ns() || !right.period_ns()) {
    return left.period_ns() ? left.period_ns() : right.period_ns();
  }
  return std::min(*left.period_ns(), *right.period_ns());
}

std::optional<double> greatestStampDifference(const StampSeries& left, const StampSeries& right) {
  if (left.stamps_ns().empty() || right.stamps_ns().empty()) return std::nullopt;
  const std::vector<double> skews_s = skewsNear(0, left, right);
  if (!skews_s.empty()) return std::max(std::abs(skews_s.front()), std::abs(skews_s.back()));
  std::int64_t nearest_ns = INT64_MAX;
  for (const std::int64_t stamp_ns : left.stamps_ns()) {
    nearest_ns = std::min(nearest_ns, std::abs(toNearest(stamp_ns, right)));
  }
  return toSeconds(nearest_ns);
}

std::optional<double> medianSkew(const StampSeries& left, const StampSeries& right) {
  const std::vector<double> skews_s = skewsNear(0, left, right);
  if (skews_s.size() < kEnough) return std::nullopt;
  return skews_s[skews_s.size() / 2];
}

std::optional<double> skewOfAPeriod(const StampSeries& left, const StampSeries& right) {
  const std::vector<double> nearest_s = skewsNear(0, left, right);
  if (nearest_s.size() < kEnough || spread(nearest_s) < kLeastJitter_s) return std::nullopt;
  for (const int periods : {-1, 1}) {
    const std::vector<double> skews_s = skewsNear(periods, left, right);
    if (skews_s.size() < kEnough || kClearlyMore * spread(skews_s) > spread(nearest_s)) continue;
    return skews_s[skews_s.size() / 2];
  }
  return std::nullopt;
}

}  // namespace rotrocc
