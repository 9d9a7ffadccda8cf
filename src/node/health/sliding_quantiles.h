#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "common/median.h"

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
    std::vector<double> values(values_.begin(), values_.end());
    return rotrocc::quantile(values, share);
  }

 private:
  std::size_t size_;
  std::deque<double> values_;
};

}  // namespace rotrocc
