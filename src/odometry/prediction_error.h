#pragma once

#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// How far the predicted positions of features were from the measured ones lately, and how deep the
/// pyramid has to be searched to find the features nevertheless.
class PredictionError {
 public:
  explicit PredictionError(const FeatureTrackerConfig& config) : config_(config) {}

  /// Adds the median distance [px] between predicted and measured positions in a pair.
  void observe(double error_px);

  /// The number of pyramid levels for the next prediction, in [levels, startup_levels]: the
  /// smallest with which the search reaches twice as far as the recent errors.
  int levels() const;

  void reset() { recent_px_ = 0.0; }

 private:
  FeatureTrackerConfig config_;
  double recent_px_ = 0.0;
};

}  // namespace rotrocc
