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

  /// Samples the inliers of a pair with a motion.
  void observe(const CheckedPair& pair);

  /// Adds the sections rows and time, the maps of the rows and their course. `keystone_rad` is the
  /// yaw of the right camera that the disparities show.
  void report(const Windows& windows, const Estimate& keystone_rad, RigReport& report);

  // Of the last report:

  /// What a calibration can correct. Rows of the shape of a yaw are not, if the disparities do not
  /// have the errors of one.
  RowModel correctable() const;
  /// Mean square of the rows, square root [px]: what a calibration is to make small.
  double rms_px() const { return rms_px_; }
  /// What the model does not explain of it: lenses leave some hundredths of a pixel.
  double remainder_px() const { return remainder_px_; }
  /// Whether the rows stay as they are: a calibration can describe them.
  bool isConstant() const { return is_constant_; }

 private:
  bool locate(const StereoPair& images, const cv::Point2f& left, cv::Point2f& right);
  void fit(const Windows& windows);
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
