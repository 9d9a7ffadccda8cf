#include "motion/outlier_rejection.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace rotrocc {
namespace {

double meanOf(const std::vector<double>& errors) {
  if (errors.empty()) return std::numeric_limits<double>::infinity();
  return std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
}

}  // namespace

double fixedLimit(double limit, double drop_share, std::vector<double>& errors) {
  if (errors.empty()) return std::numeric_limits<double>::infinity();
  const double dropped = std::ceil(drop_share * static_cast<double>(errors.size()));
  const auto highest = errors.begin() + static_cast<std::ptrdiff_t>(std::max(dropped, 1.0)) - 1;
  std::nth_element(errors.begin(), highest, errors.end(), std::greater<double>());
  return std::max(*highest, limit);
}

double meanBasedLimit(double factor, const std::vector<double>& errors) {
  return factor * meanOf(errors);
}

double deviationBasedLimit(double factor, const std::vector<double>& errors) {
  const double mean = meanOf(errors);
  double squares = 0.0;
  for (const double error : errors) squares += (error - mean) * (error - mean);
  return mean +
         factor * std::sqrt(squares / std::max(static_cast<double>(errors.size()) - 1.0, 1.0));
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
