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
/// Errors that neighboring features share do not average out over a drive as noise does. Some
/// stay with the rig, as those of a lens, and cannot be separated from a bias, so their variance is
/// added to that of the estimate; others pass with the scene, as noise. Their size is estimated
/// from the disagreement of the parts of the image; it starts from a typical one of real rigs.
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
    double mean_px, variance_px2;  ///< of the bias, the latter without lasting errors
    double shared_px;              ///< change of the bias by a lasting error as large as the noise
    double smooth_px;              ///< standard deviation of the bias by smooth errors
  };
  using Modes = std::array<Mode, 2>;  // rigid, moving

  Modes interact(double probability) const;
  static double update(const BiasMeasurement& measurement, double ratio2, Mode& mode);
  double variance(const Mode& mode) const;
  double probabilityOff(const Mode& mode) const;

  Modes modes_;
  double shared_ratio2_ = 0.0;  // variance of the shared errors over that of the noise
  double learnt_pairs_ = 0.0;   // number of pairs that it was estimated from
  double learnt_ratio2_ = 0.0;  // sum over these pairs
};

}  // namespace rotrocc
