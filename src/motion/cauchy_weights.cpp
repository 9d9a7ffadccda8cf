#include "motion/cauchy_weights.h"

#include <cstddef>

#include "common/median.h"

namespace rotrocc {
namespace {

/// Median length of a vector of two independent Gaussian numbers, in their standard deviations:
/// sqrt(2 ln 2).
constexpr double kMedianLength = 1.1774100225154747;

}  // namespace

double deviationOf(std::vector<double>& lengths_px) {
  return median(lengths_px) / kMedianLength;
}

void cauchyWeights(double factor,
                   const std::vector<double>& errors_px,
                   std::vector<double>& weights) {
  weights = errors_px;
  double scale_px = 0.0;
  if (factor > 0.0 && !weights.empty()) scale_px = factor * deviationOf(weights);
  for (std::size_t i = 0; i < errors_px.size(); ++i) {
    const double ratio = scale_px > 0.0 ? errors_px[i] / scale_px : 0.0;
    weights[i] = 1.0 / (1.0 + ratio * ratio);
  }
}

}  // namespace rotrocc
