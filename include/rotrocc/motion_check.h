#pragma once

#include <string>

#include "rotrocc/motion_estimator.h"
#include "rotrocc/uncertain_transform.h"

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
    double max_acceleration_mps2 = 30.0;  ///< a larger change of the velocity: degraded
  };

  explicit MotionCheck(const Config& config) : config_(config) {}

  /// Why the motion must not be used, in one sentence with the value and the parameter; empty if it
  /// may. The motion took `dt_s` > 0.
  std::string whyLost(const MotionEstimator::Estimate& estimate, double dt_s) const;

  /// Why a motion that may be used should be used with care; empty if there is no reason.
  std::string whyDegraded(const MotionEstimator::Estimate& estimate) const;

  /// Why a motion of `dt_s` > 0 is a jump, where `expected` would be the velocity before going on;
  /// empty if it is none: a change that the noise explains (3 standard deviations) is not.
  std::string whyJump(const UncertainTransform& motion,
                      const Eigen::Isometry3d& expected,
                      double dt_s) const;

 private:
  Config config_;
};

}  // namespace rotrocc
