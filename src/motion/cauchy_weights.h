#pragma once

#include <vector>

namespace rotrocc {

/// Cauchy's weights for iteratively reweighted least squares (Holland and Welsch 1977), for
/// residuals with a long tail: w = 1 / (1 + (e / (f s))^2), in ]0, 1].
///
/// The tails of disparities and flows are longer than Gaussian, and not even: a window at the edge
/// of something near sees it too, so that its disparity is too large. A mean follows that, a median
/// hardly does; these weights are between them.
///
/// `errors_px` are the lengths e of two-dimensional residuals. s is the standard deviation of each
/// of their directions if they were Gaussian, by the median of e. All weights are 1 if that is 0,
/// or if `factor`, f, is.
void cauchyWeights(double factor,
                   const std::vector<double>& errors_px,
                   std::vector<double>& weights);

/// Variance of weighted residuals r in each direction, sum of (w r)^2 over that of w^2, less the
/// degrees of freedom of the parameters fitted to them: the middle of the sandwich formula (Huber
/// 1967).
class WeightedVariance {
 public:
  /// `error2_px2`: |r|^2 of a two-dimensional residual.
  void add(double weight, double error2_px2) {
    ++count_;
    squares_px2_ += weight * weight * error2_px2;
    squared_weights_ += weight * weight;
  }

  /// [px^2]; 0 if there are too few residuals.
  double value(int parameters) const {
    const double rows = 2.0 * count_;
    if (!(rows > parameters)) return 0.0;
    return squares_px2_ / ((rows - parameters) * 2.0 * squared_weights_ / rows);
  }

 private:
  int count_ = 0;
  double squares_px2_ = 0.0;
  double squared_weights_ = 0.0;
};

}  // namespace rotrocc
