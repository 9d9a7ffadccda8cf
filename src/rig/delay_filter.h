#pragma once

#include <vector>

#include <Eigen/Core>

#include "features/row_search.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Follows the delay of the right images: points that move down are lower in them. So are points of
/// cameras that are turned against each other or have lenses that are known inexactly: a polynomial
/// of second degree of the place in the image. Its coefficients are estimated together with the
/// delay, by weighted least squares over the last thousand features.
class DelayFilter {
 public:
  /// Adds the features of a pair, whose flows took `dt_s` > 0.
  void add(const StereoCamera& camera, double dt_s, const std::vector<RowSample>& samples);

  const RightDelay& delay() const { return delay_; }

 private:
  void start(double fx_px, const std::vector<RowSample>& samples);

  static constexpr int kUnknowns = 7;  // the polynomial, then the delay
  static constexpr int kColumns = kUnknowns + 1;
  using Columns = Eigen::Matrix<double, kColumns, 1>;

  RightDelay delay_;
  Eigen::Matrix<double, kColumns, kColumns> normal_ = decltype(normal_)::Zero();
  Columns solution_ = -Columns::Unit(kUnknowns);  // times the columns: the residual
  double count_ = 0.0;                            // sum of the weights
  double squares_ = 0.0;   // weighted sum of squared residuals, by the estimate before
  double variance_ = 0.0;  // of a residual
};

}  // namespace rotrocc
