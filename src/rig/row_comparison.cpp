#include "rig/row_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <opencv2/core.hpp>

#include "common/median.h"

namespace rotrocc {
namespace {

/// With this many features, the scatter of tracking allows a median accurate to 0.01 px.
constexpr std::size_t kFeatures = 1000;

/// With fewer features, chance matches may agree.
constexpr std::size_t kLeastFeatures = 25;

/// Half a row. With a smaller offset, matches are searched in the same row, and real clips are as
/// accurate.
constexpr double kNotable_px = 0.5;

/// Standard deviations of the median between a notable offset and none.
constexpr double kCertain = 3.0;

/// Half rows that are counted, the outer ones with all that is beyond.
constexpr int kHalfRows = 20;

/// How many times as many features the most frequent row has as any other, if it is not by chance.
constexpr int kClearlyMore = 2;

int halfRowOf(float value_px) {
  return std::clamp(cvFloor(2.0F * value_px) + kHalfRows / 2, 0, kHalfRows - 1);
}

/// Chance matches are in all rows, and may be most of those that are searched in several rows. What
/// is far from the most frequent row is left out if this row stands out: not with a camera that is
/// rolled, whose features are in many rows.
void keepMostFrequent(std::vector<float>& values_px) {
  std::array<int, kHalfRows> counts = {};
  for (const float value_px : values_px) ++counts[halfRowOf(value_px)];
  const auto inRow = [&](int first) { return counts[first] + counts[first + 1]; };
  int most = 0;
  for (int i = 1; i + 1 < kHalfRows; ++i) {
    if (inRow(i) > inRow(most)) most = i;
  }
  for (int i = 0; i + 1 < kHalfRows; ++i) {
    if (std::abs(i - most) > 2 && kClearlyMore * inRow(i) > inRow(most)) return;
  }
  const auto isFar = [&](float value_px) {
    const int half_row = halfRowOf(value_px);
    return half_row < most - 1 || half_row > most + 2;
  };
  values_px.erase(std::remove_if(values_px.begin(), values_px.end(), isFar), values_px.end());
}

}  // namespace

RowComparison::RowComparison() : last_px_(kFeatures) {}

void RowComparison::observe(const std::vector<float>& differences_px) {
  if (differences_px.empty()) return;
  last_px_.insert(last_px_.end(), differences_px.begin(), differences_px.end());
  kept_px_.assign(last_px_.begin(), last_px_.end());
  keepMostFrequent(kept_px_);
  distances_px_.resize(kept_px_.size());
  const auto medianDistanceFrom = [&](double center_px) {
    std::transform(kept_px_.begin(), kept_px_.end(), distances_px_.begin(), [&](float value_px) {
      return std::abs(value_px - static_cast<float>(center_px));
    });
    return median(distances_px_);
  };
  offset_.median_px = median(kept_px_);
  const double scatter_px = kDeviationOverMedian * medianDistanceFrom(offset_.median_px);
  offset_.sigma_px = kMedianOverMean * scatter_px / std::sqrt(static_cast<double>(kept_px_.size()));
  offset_.typical_px = medianDistanceFrom(0.0);
  if (!isKnown()) return;
  const double notable_px = std::max(kNotable_px, scatter_px);
  const double least_px = offset_.applied_px != 0.0 ? 0.5 * notable_px : notable_px;
  offset_.applied_px = std::abs(offset_.median_px) > least_px ? offset_.median_px : 0.0;
}

bool RowComparison::isKnown() const {
  return kept_px_.size() >= kLeastFeatures && kCertain * offset_.sigma_px <= kNotable_px;
}

bool RowComparison::isNear(double offset_px) const {
  return !last_px_.empty() && std::abs(offset_.median_px - offset_px) <= kNotable_px;
}

void RowComparison::searchAgain() {
  if (!isKnown()) return;
  last_px_.clear();
  kept_px_.clear();
}

void RowComparison::scale(double factor) {
  for (float& difference_px : last_px_) difference_px *= static_cast<float>(factor);
  for (double* px :
       {&offset_.median_px, &offset_.sigma_px, &offset_.typical_px, &offset_.applied_px}) {
    *px *= factor;
  }
}

}  // namespace rotrocc
