#pragma once

#include <vector>

#include "rotrocc/correspondence.h"

namespace rotrocc {

/// The error threshold between inliers and outliers, computed in each iteration from the errors of
/// the current set.
class OutlierThreshold {
 public:
  /// Eq. 26 and 30: the larger of a fixed limit and the b-th highest error, where b is `drop_share`
  /// of the set. No iteration drops a larger share.
  static OutlierThreshold fixedLimit(double limit, double drop_share);
  /// Eq. 32: `factor` times the mean error.
  static OutlierThreshold meanBased(double factor);
  /// Eq. 31: `factor` standard deviations above the mean error.
  static OutlierThreshold deviationBased(double factor);

  /// The threshold for the errors of the features flagged in `set`. Infinite if the set is empty.
  double operator()(const std::vector<double>& errors, const FeatureSet& set);

 private:
  enum class Rule { kFixedLimit, kMean, kDeviation };
  OutlierThreshold(Rule rule, double limit, double drop_share)
      : rule_(rule), limit_(limit), drop_share_(drop_share) {}

  Rule rule_;
  double limit_;
  double drop_share_;
  std::vector<double> sorted_;
};

/// Flags in `set` exactly the features with an error below `threshold`. Dropped features may be
/// added again, as in Eq. 26. Returns whether the set changed.
bool keepBelow(const std::vector<double>& errors, double threshold, FeatureSet& set);

/// Number of features in a set.
int count(const FeatureSet& set);

}  // namespace rotrocc
