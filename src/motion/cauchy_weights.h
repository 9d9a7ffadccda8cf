#pragma once

#include <vector>

namespace rotrocc {

/// Standard deviation, in each direction, of two-dimensional Gaussian residuals from the median of
/// their lengths; there must be one. Reorders `lengths_px`.
double deviationOf(std::vector<double>& lengths_px);

/// Cauchy weights for iteratively reweighted least squares (Holland and Welsch 1977), for residuals
/// with long tails: w = 1 / (1 + (e / (f s))^2), in ]0, 1].
///
/// The tails of disparity and flow errors are longer than Gaussian tails and not symmetric: a
/// window at the edge of a near object also contains that object, so its disparity is too large.
/// Such errors bias the mean, but hardly the median. These weights are a compromise between the
/// two.
///
/// `errors_px` are the lengths e of two-dimensional residuals. s is their standard deviation in
/// each direction, estimated from the median of e for Gaussian residuals. f is `factor`. All
/// weights are 1 if s or f is 0.
void cauchyWeights(double factor,
                   const std::vector<double>& errors_px,
                   std::vector<double>& weights);

/// Variance of weighted residuals r in each direction: the sum of (w r)^2 divided by the sum of
/// w^2, corrected for the degrees of freedom of the fitted parameters. This is the middle term of
/// the sandwich formula (Huber 1967).
class WeightedVariance {
 public:
  /// `error2_px2`: |r|^2 of a two-dimensional residual.
  void add(double weight, double error2_px2) {
    ++count_;
    squares_px2_ += weight * weight * error2_px2;
    squared_weights_ += weight * weight;
  }

  double squaredWeights() const { return squared_weights_; }

  /// Returns the variance [px^2], or 0 if there are too few residuals.
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
