#include "motion/motion_solver.h"

#include <cmath>
#include <limits>

#include <ceres/tiny_solver.h>
#include <Eigen/Core>

#include "motion/feature_errors.h"
#include "motion/reprojection_problem.h"

namespace rotrocc {
namespace {

/// TinySolver of Ceres 1.14 has no function_tolerance: there it continues to the other limits.
template <class SolverOptions>
auto setFunctionTolerance(SolverOptions& options, double tolerance, int)
    -> decltype(options.function_tolerance, void()) {
  options.function_tolerance = tolerance;
}
template <class SolverOptions>
void setFunctionTolerance(SolverOptions&, double, long) {}

/// Minimizes the cost: no step increases it. Also stops when a step changes the parameters by less
/// than 1e-7 of their length. Returns false, with undefined parameters, if these are not finite.
template <int kParameters>
bool minimize(const ReprojectionProblem<kParameters>& problem,
              const MotionSolver::Options& options,
              Eigen::Matrix<double, kParameters, 1>& parameters) {
  ceres::TinySolver<ReprojectionProblem<kParameters>> solver;
  solver.options.max_num_iterations = options.max_steps + 1;  // it counts the start
  solver.options.initial_trust_region_radius = 1.0 / options.damping;
  solver.options.parameter_tolerance = 1e-7;
  setFunctionTolerance(solver.options, 0.5 * options.min_cost_change_px2, 0);
  const auto& summary = solver.Solve(problem, &parameters);
  return parameters.allFinite() && std::isfinite(summary.final_cost);
}

}  // namespace

MotionSolver::Options MotionSolver::refinement() {
  // Gauss-Newton steps with negligible damping, because the start is close to the minimum.
  return {kCauchyFactor, true, 4, 1e-12, std::numeric_limits<double>::infinity(), 1};
}

template <int kParameters>
bool MotionSolver::solve(const Measurements& measured,
                         const FeatureSet& set,
                         double parabola_ratio,
                         ReprojectionProblem<kParameters>& problem,
                         Fit& fit) const {
  for (int i = 0; i < options_.minimizations; ++i) {
    problem.assign(measured.camera, fit, set);
    if (2 * problem.size() < kParameters) return false;  // a feature gives two equations
    auto parameters = problem.start();
    problem.weigh(parameters, options_.robust_factor);
    if (options_.shares_errors) problem.shareErrors(kSharedRatio, parabola_ratio);
    if (!minimize(problem, options_, parameters)) return false;
    fitAt(measured, problem.motionAt(parameters), fit);
  }
  return true;
}

bool MotionSolver::solveMotion(const Measurements& measured, const FeatureSet& set, Fit& fit) {
  // Without the parabola: a rotation hardly depends on disparities, and needs all features.
  return solve(measured, set, 0.0, motion_problem_, fit);
}

bool MotionSolver::solveTranslation(const Measurements& measured, const FeatureSet& set, Fit& fit) {
  return solve(measured, set, kSmoothRatio, translation_problem_, fit);
}

}  // namespace rotrocc
