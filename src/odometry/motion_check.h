#pragma once

#include <string>

#include "motion/motion_estimator.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/uncertain_transform.h"

namespace rotrocc {

/// Whether an estimated motion can be believed.
class MotionCheck {
 public:
  using Config = MotionCheckConfig;

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
