#pragma once

#include <vector>

#include <boost/circular_buffer.hpp>

#include "common/median.h"

namespace rotrocc {

/// The latest measurements of something.
using Latest = boost::circular_buffer<double>;

/// Quantile `share` in [0, 1]; 0 without measurements.
inline double quantileOf(const Latest& latest, double share) {
  std::vector<double> values(latest.begin(), latest.end());
  return values.empty() ? 0.0 : quantile(values, share);
}

}  // namespace rotrocc
