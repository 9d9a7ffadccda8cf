#pragma once

#include <cstddef>
#include <vector>

namespace rotrocc {

/// Weights for iteratively reweighted least squares (Holland and Welsch 1977): the w = 1 / (1 + (e
/// / (f s))^2) of Cauchy, for residuals with a long tail.
///
/// The tails of disparities and flows are longer than Gaussian, and not even: a window at the edge
/// of something near sees it too, so that its disparity is too large. A median knows
/// nothing of that, a mean does; these weights are between them.
class CauchyWeights {
 public:
  /// `factor`: f, at least 0. With 0 all weights are 1.
  explicit CauchyWeights(double factor) : factor_(factor) {}

  /// From the lengths e [px] of two-dimensional residuals. s is the standard deviation of each of
  /// their directions if they were Gaussian, by the median of e; if that is 0, all weights are 1.
  void update(const std::vector<double>& errors_px);

  /// In ]0, 1], in the order of the errors given last.
  double operator[](std::size_t i) const { return weights_[i]; }

 private:
  double factor_;
  std::vector<double> weights_;
  std::vector<double> sorted_;  // kept for its memory
};

}  // namespace rotrocc
