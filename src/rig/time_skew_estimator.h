#pragma once

#include <vector>

#include <Eigen/Core>

#include "features/row_search.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Estimates the TimeSkew from the row offsets of the features: those of a right image that is
/// taken later are proportional to the vertical velocity of the features. A right camera that is
/// turned, and lenses, cause offsets as well; these are smooth over the image, and are fitted
/// together with the skew as a quadratic polynomial. What moves sidewards only shows no skew.
class TimeSkewEstimator {
 public:
  TimeSkewEstimator() { reset(); }

  /// Adds a pair. `interval_s`: time from the keyframe of the features to the pair.
  void observe(const StereoCamera& camera,
               const Correspondences& features,
               const RowOffsets& rows,
               double interval_s);

  TimeSkew skew() const;

  /// Discards all data, for use with another camera.
  void reset();

 private:
  static constexpr int kUnknowns = 7;  // the polynomial and the skew
  static constexpr int kSkew = kUnknowns - 1;
  using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

  static Unknowns coefficients(const StereoCamera& camera,
                               const Correspondence& feature,
                               double interval_s);

  // Sums over the features, later ones with more weight.
  Eigen::Matrix<double, kUnknowns, kUnknowns> information_;
  Unknowns weighted_px_;
  double squares_px2_ = 0.0;
  double weights_ = 0.0;

  // Buffers, reused.
  std::vector<Unknowns> rows_;
  std::vector<double> errors_px_, robust_weights_;
};

}  // namespace rotrocc
