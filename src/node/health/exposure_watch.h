#pragma once

#include <string>

#include "node/health/sliding_quantiles.h"
#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Detects cameras whose exposures differ or move against each other so much that one of the images
/// is likely to be dark or saturated. Smaller differences cost nothing.
class ExposureWatch {
 public:
  /// Number of pairs that are watched, and that suffice for a hint.
  static constexpr std::size_t kPairs = 50;
  static constexpr std::size_t kLeastPairs = 10;

  /// The fault and a remedy, in one sentence; empty if there is none. Pairs without a motion do not
  /// count.
  std::string observe(const OdometryResult& result);

 private:
  SlidingQuantiles gains_{kPairs};
};

}  // namespace rotrocc
