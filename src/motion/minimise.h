#pragma once

#include <cmath>

#include <ceres/tiny_solver.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "motion/reprojection_problem.h"

namespace rotrocc {

/// Presents a problem with many residuals to ceres::TinySolver as one with few residuals that has
/// the same J^T J, J^T r and r^T r. The solver uses nothing else.
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
    // A square root of the normal matrix, which is positive semidefinite except for rounding
    // errors.
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

/// TinySolver of Ceres 1.14 has no function_tolerance: there it goes on to the other limits.
template <class Options>
auto setFunctionTolerance(Options& options, double tolerance, int)
    -> decltype(options.function_tolerance, void()) {
  options.function_tolerance = tolerance;
}
template <class Options>
void setFunctionTolerance(Options&, double, long) {}

/// Options of a minimisation.
struct MinimiseOptions {
  double damping = 1e-4;              ///< initial damping, relative to the diagonal of J^T J
  double min_cost_change_px2 = 2e-6;  ///< stop when a step changes the cost by less
  int max_steps = 19;
};

/// Minimises the cost by Levenberg-Marquardt: no step increases it. Stops when a step changes the
/// parameters by less than 1e-7 of their length or the cost by less than the given limit, or after
/// `max_steps`. Returns false, with undefined parameters, if the result is not finite.
template <int kParameters>
bool minimise(const ReprojectionProblem<kParameters>& problem,
              const MinimiseOptions& options,
              Eigen::Matrix<double, kParameters, 1>& parameters) {
  ceres::TinySolver<CondensedProblem<kParameters>> solver;
  solver.options.max_num_iterations = options.max_steps + 1;  // it counts the start
  solver.options.initial_trust_region_radius = 1.0 / options.damping;
  solver.options.parameter_tolerance = 1e-7;
  setFunctionTolerance(solver.options, 0.5 * options.min_cost_change_px2, 0);
  const auto& summary = solver.Solve(CondensedProblem<kParameters>(problem), &parameters);
  return parameters.allFinite() && std::isfinite(summary.final_cost);
}

}  // namespace rotrocc
