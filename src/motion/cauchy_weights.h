#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace rotrocc {

/// Cauchy's weights for iteratively reweighted least squares (Holland and Welsch 1977), for
/// residuals with a long tail: w = 1 / (1 + (e / (f s))^2).
///
/// The tails of disparities and flows are longer than Gaussian, and not even: a window at the edge
/// of something near sees it too, so that its disparity is too large. A mean follows that, a median
/// hardly does; these weights are between them.
class CauchyWeights {
 public:
  /// `factor`: f, at least 0. With 0 all weights are 1.
  explicit CauchyWeights(double factor) : factor_(factor) {}

  /// From the lengths e [px] of two-dimensional residuals. s is the standard deviation of each of
  /// their directions if they were Gaussian, by the median of e; if that is 0, all weights are 1.
  void update(const std::vector<double>& errors_px);

  /// In ]0, 1], in the order of the errors given last.
  double operator[](std::size_t i) const { return weights_[i]; }

  /// Variance [px^2] of the residuals r in each direction, sum of (w r)^2 over that of w^2, less
  /// the degrees of freedom of the parameters fitted to them: the middle of the sandwich formula
  /// (Huber 1967). `weighted_px`: sqrt(w) r, x and y of each in turn. 0 if there are too few.
  double variance(const Eigen::Ref<const Eigen::VectorXd>& weighted_px, int parameters) const;

 private:
  double factor_;
  std::vector<double> weights_;
  std::vector<double> sorted_;  // kept for its memory
};

}  // namespace rotrocc
