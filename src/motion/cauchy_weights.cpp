#include "motion/cauchy_weights.h"

#include <algorithm>

namespace rotrocc {
namespace {

/// Of the length of a vector of two Gaussian numbers, in their standard deviations: sqrt(2 ln 2).
constexpr double kMedianLength = 1.1774100225154747;

}  // namespace

void CauchyWeights::update(const std::vector<double>& errors_px) {
  weights_.assign(errors_px.size(), 1.0);
  if (factor_ == 0.0 || errors_px.empty()) return;
  sorted_ = errors_px;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  const double scale_px = factor_ * *middle / kMedianLength;
  if (!(scale_px > 0.0)) return;
  for (std::size_t i = 0; i < errors_px.size(); ++i) {
    const double ratio = errors_px[i] / scale_px;
    weights_[i] = 1.0 / (1.0 + ratio * ratio);
  }
}

double CauchyWeights::variance(const Eigen::Ref<const Eigen::VectorXd>& weighted_px,
                               int parameters) const {
  double weighted_squares = 0.0;
  double squared_weights = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    weighted_squares += weights_[i] * weighted_px.segment<2>(row).squaredNorm();
    squared_weights += weights_[i] * weights_[i];
  }
  const auto rows = static_cast<double>(weighted_px.size());
  if (!(rows > parameters)) return 0.0;
  return weighted_squares / ((rows - parameters) * 2.0 * squared_weights / rows);
}

}  // namespace rotrocc
