#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <vector>

namespace rotrocc {

/// Quantiles of the last `size` measurements of something.
class SlidingQuantiles {
 public:
  explicit SlidingQuantiles(std::size_t size) : size_(size) {}

  void add(double value) {
    values_.push_back(value);
    if (values_.size() > size_) values_.pop_front();
  }

  std::size_t size() const { return values_.size(); }

  /// Quantile `share` in [0, 1]; 0 without measurements.
  double quantile(double share) const {
    if (values_.empty()) return 0.0;
    std::vector<double> sorted(values_.begin(), values_.end());
    std::sort(sorted.begin(), sorted.end());
    const double rank = std::ceil(share * static_cast<double>(sorted.size())) - 1.0;
    return sorted[static_cast<std::size_t>(std::max(rank, 0.0))];
  }

 private:
  std::size_t size_;
  std::deque<double> values_;
};

}  // namespace rotrocc
