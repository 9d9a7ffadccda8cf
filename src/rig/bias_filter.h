#pragma once

#include "rig/bias_meter.h"
#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Follows the disparity bias of a rig over the measurements of single pairs: a Kalman filter of a
/// random walk, as lenses settle and mounts flex. A rig is off by an angle, so the bias is a share
/// of the focal length, whatever the size of the images.
///
/// Errors that neighboring features share do not average out over a drive as noise does: those of a
/// lens stay with the rig, and cannot be separated from a bias. Their variance is added to that of
/// the estimate.
///
/// A measurement that is off by more than its variance admits has little weight (Student's t), but
/// makes the estimate uncertain: either it is wrong, or the rig was hit. The next ones decide.
class BiasFilter {
 public:
  /// Standard deviation of the bias of rigs: that of KITTI's drives is up to 1.2 px.
  static constexpr double kPrior_rad = 1.4e-3;

  /// `measurement` is relative to the known bias, of images with the focal length `fx_px`.
  void add(const BiasMeasurement& measurement, double fx_px);

  /// The estimate, relative to the known bias. `applied_px` is weighted by the probability that the
  /// rig is off at all. A rig that was off remains so: less evidence suffices from then on.
  DisparityBias bias(double fx_px) const;

 private:
  double logOdds() const;

  double mean_rad_ = 0.0;
  double variance_rad2_ = kPrior_rad * kPrior_rad;  // without shared errors
  double shared_rad_ = 0.0;  // standard deviation of the measurements by shared errors
  bool is_off_ = false;
};

}  // namespace rotrocc
