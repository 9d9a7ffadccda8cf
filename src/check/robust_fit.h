#pragma once

#include <vector>

#include <Eigen/Core>

namespace rotrocc {

/// Parameters with standard deviations, which are infinite if the data do not determine them.
struct RobustFit {
  Eigen::Vector3d parameters;
  Eigen::Vector3d sigmas;
};

/// Least squares for values = rows^T parameters, as many of both, with Cauchy weights: see
/// cauchyWeights(). Errors are of one size, which is found.
RobustFit fitRobustly(const std::vector<Eigen::Vector3d>& rows, const std::vector<double>& values);

}  // namespace rotrocc
