#include "motion/outlier_rejection.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace rotrocc {

OutlierThreshold OutlierThreshold::fixedLimit(double limit, double drop_share) {
  return {Rule::kFixedLimit, limit, drop_share};
}

OutlierThreshold OutlierThreshold::meanBased(double factor) {
  return {Rule::kMean, factor, 0.0};
}

OutlierThreshold OutlierThreshold::deviationBased(double factor) {
  return {Rule::kDeviation, factor, 0.0};
}

double OutlierThreshold::operator()(const std::vector<double>& errors, const FeatureSet& set) {
  sorted_.clear();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (set[i] != 0) sorted_.push_back(errors[i]);
  }
  if (sorted_.empty()) return std::numeric_limits<double>::infinity();
  const auto size = static_cast<double>(sorted_.size());

  if (rule_ == Rule::kFixedLimit) {
    const auto dropped = static_cast<std::ptrdiff_t>(std::ceil(drop_share_ * size));
    const auto highest = sorted_.begin() + std::max<std::ptrdiff_t>(dropped, 1) - 1;
    std::nth_element(sorted_.begin(), highest, sorted_.end(), std::greater<double>());
    return std::max(*highest, limit_);
  }

  const double mean = std::accumulate(sorted_.begin(), sorted_.end(), 0.0) / size;
  if (rule_ == Rule::kMean) return limit_ * mean;
  double squares = 0.0;
  for (const double error : sorted_) squares += (error - mean) * (error - mean);
  return mean + limit_ * std::sqrt(squares / std::max(size - 1.0, 1.0));
}

bool keepBelow(const std::vector<double>& errors, double threshold, FeatureSet& set) {
  bool changed = false;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const char kept = errors[i] < threshold ? 1 : 0;
    changed = changed || kept != set[i];
    set[i] = kept;
  }
  return changed;
}

int count(const FeatureSet& set) {
  return static_cast<int>(std::count(set.begin(), set.end(), static_cast<char>(1)));
}

}  // namespace rotrocc
