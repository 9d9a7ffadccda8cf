#include "input/stamps.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "common/to_seconds.h"

namespace rotrocc {
namespace {

/// In periods: a longer step is one over lost images.
constexpr double kLongestStep = 1.5;
constexpr std::size_t kEnoughForMedian = 16;
/// Spread of the differences of neighbors: more than between well synchronized clocks ...
constexpr double kLeastJitter_s = 2e-4;
/// ... and times the spread of images of the same time, beyond chance.
constexpr double kClearlyMore = 4.0;

/// Right minus left stamps of images that are `shift_ns` apart, give or take `tolerance_ns`;
/// sorted.
std::vector<double> skewsNear(std::int64_t shift_ns,
                              Stamps left_ns,
                              const Stamps& right_ns,
                              std::int64_t tolerance_ns) {
  for (std::int64_t& stamp_ns : left_ns) stamp_ns += shift_ns;
  std::vector<double> skews_s;
  for (const auto& [i, j] : matchStamps(left_ns, right_ns, tolerance_ns)) {
    skews_s.push_back(toSeconds(right_ns[j] - left_ns[i] + shift_ns));
  }
  std::sort(skews_s.begin(), skews_s.end());
  return skews_s;
}

/// Half of the values are within so much.
double spread(const std::vector<double>& sorted) {
  return sorted[sorted.size() * 3 / 4] - sorted[sorted.size() / 4];
}

}  // namespace

std::optional<std::int64_t> periodOf(const Stamps& stamps_ns) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t i = 1; i < stamps_ns.size(); ++i) {
    const std::int64_t step_ns = stamps_ns[i] - stamps_ns[i - 1];
    if (step_ns > 0) steps_ns.push_back(step_ns);
  }
  if (steps_ns.empty()) return std::nullopt;
  std::sort(steps_ns.begin(), steps_ns.end());
  const auto quartile_ns = static_cast<double>(steps_ns[(steps_ns.size() - 1) / 4]);
  const auto end = std::upper_bound(steps_ns.begin(), steps_ns.end(), kLongestStep * quartile_ns);
  return steps_ns[static_cast<std::size_t>(end - steps_ns.begin() - 1) / 2];
}

std::vector<std::pair<std::size_t, std::size_t>> matchStamps(const Stamps& left_ns,
                                                             const Stamps& right_ns,
                                                             std::int64_t tolerance_ns) {
  const auto difference = [&](std::size_t i, std::size_t j) {
    return std::abs(left_ns[i] - right_ns[j]);
  };
  std::vector<std::pair<std::size_t, std::size_t>> matches;
  std::size_t j = 0;
  for (std::size_t i = 0; i < left_ns.size() && j < right_ns.size(); ++i) {
    while (j + 1 < right_ns.size() && difference(i, j + 1) < difference(i, j)) ++j;
    const bool next_is_nearer = i + 1 < left_ns.size() && difference(i + 1, j) < difference(i, j);
    if (!next_is_nearer && difference(i, j) <= tolerance_ns) matches.emplace_back(i, j++);
  }
  return matches;
}

std::optional<StampSkew> skewOf(const Stamps& left_ns,
                                const Stamps& right_ns,
                                std::optional<std::int64_t> period_ns) {
  if (left_ns.empty() || right_ns.empty()) return std::nullopt;
  const std::int64_t tolerance_ns = period_ns.value_or(0) / 2;
  std::vector<double> nearest_s = skewsNear(0, left_ns, right_ns, tolerance_ns);
  const bool is_enough = nearest_s.size() >= kEnoughForMedian;
  if (nearest_s.empty()) {
    nearest_s = skewsNear(0, left_ns, right_ns, std::numeric_limits<std::int64_t>::max());
    const auto size = [](double a, double b) { return std::abs(a) < std::abs(b); };
    return StampSkew{std::abs(*std::min_element(nearest_s.begin(), nearest_s.end(), size)), {}, {}};
  }
  StampSkew skew = {std::max(std::abs(nearest_s.front()), std::abs(nearest_s.back())), {}, {}};
  if (!is_enough) return skew;
  skew.median_s = nearest_s[nearest_s.size() / 2];
  if (spread(nearest_s) < kLeastJitter_s) return skew;
  for (const std::int64_t shift_ns : {-*period_ns, *period_ns}) {
    const std::vector<double> skews_s = skewsNear(shift_ns, left_ns, right_ns, tolerance_ns);
    if (skews_s.size() < kEnoughForMedian) continue;
    if (kClearlyMore * spread(skews_s) > spread(nearest_s)) continue;
    skew.of_a_period_s = skews_s[skews_s.size() / 2];
    break;
  }
  return skew;
}

}  // namespace rotrocc
