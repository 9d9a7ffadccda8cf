#pragma once

#include <array>

#include "rig/bias_meter.h"
#include "rotrocc/odometry_result.h"

namespace rotrocc {

/// Follows the disparity bias of a rig over the measurements of single pairs.
///
/// There are two modes: the rig is rigid, or it moves, so its bias is a random walk. Each has
/// a Kalman filter, and they interact as in the IMM (Blom and Bar-Shalom 1988): a rig changes from
/// one to the other once in 300 pairs on average.
///
/// Errors that neighboring features share do not average out over a drive as noise does: those of a
/// lens stay with the rig, and cannot be separated from a bias. Their variance is added to that of
/// the estimate.
///
/// A measurement that is off by more than its variance admits has little weight (Student's t),
/// unless the next ones confirm it.
class BiasFilter {
 public:
  BiasFilter();

  /// `measurement` is relative to the known bias.
  void add(const BiasMeasurement& measurement);

  /// Pixels become so many times as small, as in an enlarged image.
  void scale(double factor);

  /// The estimate over both modes, relative to the known bias. `applied_px` is weighted by
  /// the probability that the rig is off at all.
  DisparityBias bias() const;

 private:
  struct Mode {
    double probability;
    double walk_px;  ///< standard deviation of the change of the bias from pair to pair
    double mean_px, variance_px2;  ///< of the bias, the latter without shared errors
    double shared_px;              ///< standard deviation of the measurements by shared errors
  };
  using Modes = std::array<Mode, 2>;  // rigid, moving

  Modes interact(double probability) const;
  static double update(const BiasMeasurement& measurement, Mode& mode);
  static double variance(const Mode& mode);
  static double probabilityOff(const Mode& mode);

  Modes modes_;
};

}  // namespace rotrocc
