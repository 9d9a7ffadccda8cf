#pragma once

#include <cstddef>
#include <vector>

#include "check/pair_check.h"
#include "check/row_model.h"
#include "features/feature_tracker.h"
#include "rotrocc/odometry_config.h"

namespace rotrocc {

/// Measures how rows of the right image differ from those of the left one, and what explains it.
class RowCheck {
 public:
  explicit RowCheck(const OdometryConfig& config)
      : tracker_(config.correspondence_finder.feature_tracker) {}

  void observe(const CheckedPair& pair);

  /// `keystone_rad`: yaw of the right camera that the disparities show.
  void report(const Windows& windows, const Estimate& keystone_rad, RigReport& report);

  // Of the last report:

  /// What a calibration can correct: not a yaw whose errors the disparities do not have.
  RowModel correctable() const;
  double rms_px() const { return rms_px_; }
  /// Rms that the model does not explain: lenses leave some hundredths of a pixel.
  double remainder_px() const { return remainder_px_; }
  bool isConstant() const { return is_constant_; }

 private:
  double yawShare() const;
  void addCauses(RigReport& report) const;
  void addMap(RigReport& report);
  void addCourse(RigReport& report);

  FeatureTracker tracker_;
  StereoCamera camera_;
  std::vector<RowSample> samples_;
  RowModel model_;
  Estimate keystone_rad_;
  double rms_px_ = 0.0;
  double remainder_px_ = 0.0;
  bool is_constant_ = true;
};

}  // namespace rotrocc
