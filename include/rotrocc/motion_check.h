#pragma once

#include <string>

#include "rotrocc/motion_estimator.h"

namespace rotrocc {

/// Whether an estimated motion can be believed.
class MotionCheck {
 public:
  struct Config {
    int min_inliers = 25;                 ///< fewer: lost
    double min_inlier_share = 0.15;       ///< of the feature set; less: lost
    int degraded_inliers = 80;            ///< fewer: degraded
    double degraded_inlier_share = 0.35;  ///< of the feature set; less: degraded
    double max_speed_mps = 70.0;          ///< faster: lost
    double max_turn_rate_rps = 6.0;       ///< faster: lost
  };

  explicit MotionCheck(const Config& config) : config_(config) {}

  /// Why the motion must not be used, in one sentence with the value and the parameter; empty if it
  /// may. The motion took `dt_s` > 0.
  std::string whyLost(const MotionEstimator::Estimate& estimate, double dt_s) const;

  /// Why a motion that may be used should be used with care; empty if there is no reason.
  std::string whyDegraded(const MotionEstimator::Estimate& estimate) const;

 private:
  Config config_;
};

}  // namespace rotrocc
