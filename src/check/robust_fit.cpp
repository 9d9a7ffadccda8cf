#include "check/robust_fit.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/median.h"
#include "motion/feature_errors.h"

namespace rotrocc {
namespace {

/// Weights of 2.3 standard deviations, for 95 % efficiency: cauchyWeights() takes errors for
/// lengths of two-dimensional ones, whose median is longer.
constexpr double kRobust = 4.0;
constexpr int kIterations = 10;

}  // namespace

RobustFit fitRobustly(const std::vector<Eigen::Vector3d>& rows, const std::vector<double>& values) {
  RobustFit fit = {Eigen::Vector3d::Zero(),
                   Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};
  if (rows.empty()) return fit;
  std::vector<double> weights(rows.size(), 1.0);
  std::vector<double> errors(rows.size());
  Eigen::Matrix3d information;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    information.setZero();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      information += weights[i] * rows[i] * rows[i].transpose();
      weighted += weights[i] * values[i] * rows[i];
    }
    fit.parameters = information.ldlt().solve(weighted);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      errors[i] = std::abs(values[i] - rows[i].dot(fit.parameters));
    }
    cauchyWeights(kRobust, errors, weights);
  }
  const double noise = kDeviationOverMedian * median(errors);
  const Eigen::Vector3d sigmas = noise * information.inverse().diagonal().cwiseSqrt();
  if (sigmas.allFinite()) fit.sigmas = sigmas;
  return fit;
}

}  // namespace rotrocc
