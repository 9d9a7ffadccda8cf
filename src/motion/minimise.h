#pragma once

#include <cmath>

#include <ceres/tiny_solver.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "motion/reprojection_problem.h"

namespace rotrocc {

/// What ceres::TinySolver gets to see of a problem with many residuals: a few that have the same
/// J^T J, J^T r and r^T r, which is all it makes use of.
template <int kParameters>
class CondensedProblem {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = kParameters + 1, NUM_PARAMETERS = kParameters };

  explicit CondensedProblem(const ReprojectionProblem<kParameters>& problem) : problem_(problem) {}

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const Eigen::Map<const Eigen::Matrix<double, kParameters, 1>> p(parameters);
    Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, 1>> r(residuals);
    if (jacobian == nullptr) {
      r.setZero();
      r[0] = std::sqrt(problem_.cost(p));
      return true;
    }
    // A root of the normal matrix, which is positive semidefinite but for rounding.
    using Matrix = typename ReprojectionProblem<kParameters>::NormalMatrix;
    const Eigen::LDLT<Matrix> ldlt(problem_.normalMatrix(p));
    const Matrix root = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                        Matrix(ldlt.matrixU()) *
                        Matrix(ldlt.transpositionsP() * Matrix::Identity());
    r = root.col(kParameters);
    Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, kParameters>> J(jacobian);
    J = root.template leftCols<kParameters>();
    return true;
  }

 private:
  const ReprojectionProblem<kParameters>& problem_;
};

/// How a minimisation goes.
struct MinimiseOptions {
  double damping = 1e-4;                ///< at the start, of the diagonal of the normal equations
  double least_cost_change_px2 = 2e-6;  ///< a step that changes the cost by less is the last one
};

/// Minimises the cost by Levenberg-Marquardt: no step makes it larger. Ends when a step changes the
/// parameters by less than 1e-7 of their length or the cost by too little, after 20 steps at most.
/// Returns false, with the parameters undefined, if they are not finite at the end.
template <int kParameters>
bool minimise(const ReprojectionProblem<kParameters>& problem,
              const MinimiseOptions& options,
              Eigen::Matrix<double, kParameters, 1>& parameters) {
  ceres::TinySolver<CondensedProblem<kParameters>> solver;
  solver.options.max_num_iterations = 20;
  solver.options.initial_trust_region_radius = 1.0 / options.damping;
  solver.options.parameter_tolerance = 1e-7;
  solver.options.function_tolerance = 0.5 * options.least_cost_change_px2;
  const auto& summary = solver.Solve(CondensedProblem<kParameters>(problem), &parameters);
  return parameters.allFinite() && std::isfinite(summary.final_cost);
}

}  // namespace rotrocc
