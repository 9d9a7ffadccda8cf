#include "rig/row_comparison.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

RowComparison::RowComparison() : last_px_(kFeatures) {
  sorted_px_.reserve(kFeatures);
}

void RowComparison::observe(const std::vector<float>& differences_px) {
  if (differences_px.empty()) return;
  last_px_.insert(last_px_.end(), differences_px.begin(), differences_px.end());
  const auto medianDistanceFrom = [&](double center_px) {
    std::transform(last_px_.begin(), last_px_.end(), sorted_px_.begin(), [&](float value_px) {
      return std::abs(value_px - static_cast<float>(center_px));
    });
    return median(sorted_px_);
  };
  sorted_px_.assign(last_px_.begin(), last_px_.end());
  offset_.median_px = median(sorted_px_);
  const double scatter_px = kDeviationOverMedian * medianDistanceFrom(offset_.median_px);
  offset_.sigma_px = kMedianOverMean * scatter_px / std::sqrt(static_cast<double>(last_px_.size()));
  offset_.typical_px = medianDistanceFrom(0.0);
  if (!isKnown()) return;
  const double notable_px = std::max(kNotable_px, scatter_px);
  const double least_px = offset_.applied_px != 0.0 ? 0.5 * notable_px : notable_px;
  offset_.applied_px = std::abs(offset_.median_px) > least_px ? offset_.median_px : 0.0;
}

bool RowComparison::isKnown() const {
  return last_px_.size() >= kLeastFeatures && kCertain * offset_.sigma_px <= kNotable_px;
}

bool RowComparison::isNear(double offset_px) const {
  return !last_px_.empty() && std::abs(offset_.median_px - offset_px) <= kNotable_px;
}

void RowComparison::searchAgain() {
  if (isKnown()) last_px_.clear();
}

void RowComparison::scale(double factor) {
  for (float& difference_px : last_px_) difference_px *= static_cast<float>(factor);
  for (double* px :
       {&offset_.median_px, &offset_.sigma_px, &offset_.typical_px, &offset_.applied_px}) {
    *px *= factor;
  }
}

void RowComparison::reset() {
  offset_ = {};
  last_px_.clear();
}

}  // namespace rotrocc
