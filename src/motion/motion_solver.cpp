#include "motion/motion_solver.h"

#include <cmath>

#include <ceres/tiny_solver.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "motion/feature_errors.h"
#include "rotrocc/rigid_motion.h"

namespace rotrocc {
namespace {

/// Limits of one minimization: it usually takes two or three steps.
constexpr int kMaxMinimizerSteps = 19;

/// Steps of the refinement, each with new weights.
constexpr int kRefinements = 4;

/// Standard deviation of an error that neighbors share, over the flow noise: 2.4 to 6 on the rigs
/// of KITTI, Karlsruhe and EuRoC.
constexpr double kSharedRatio = 3.0;

/// For ceres::TinySolver: a problem with few residuals and the same J^T J, J^T r and r^T r. The
/// solver uses nothing else. The parameters are a rotation vector relative to the motion of the
/// problem, if there are six, and the translation.
template <int kParameters>
struct Condensed {
  using Scalar = double;
  enum { NUM_RESIDUALS = kParameters + 1, NUM_PARAMETERS = kParameters };
  using Parameters = Eigen::Matrix<double, kParameters, 1>;

  const ReprojectionProblem& problem;

  Parameters start() const {
    Parameters parameters = Parameters::Zero();
    parameters.template tail<3>() = problem.motion().translation();
    return parameters;
  }

  Eigen::Isometry3d motionAt(const Parameters& parameters) const {
    Eigen::Isometry3d T = problem.motion();
    if constexpr (kParameters == 6) {
      const Eigen::Matrix3d R = expRotation(parameters.template head<3>()) * T.linear();
      T.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
    }
    T.translation() = parameters.template tail<3>();
    return T;
  }

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const Eigen::Map<const Parameters> p(parameters);
    const Eigen::Isometry3d T = motionAt(p);
    Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, 1>> r(residuals);
    if (jacobian == nullptr) {
      constexpr int kResidual = LinearBlock::kResidual;
      r.setZero();
      r[0] = std::sqrt(problem.normalMatrix(T, kResidual)(kResidual, kResidual));
      return true;
    }
    using Normal = Eigen::Matrix<double, NUM_RESIDUALS, NUM_RESIDUALS>;
    Normal normal = problem.normalMatrix(T, LinearBlock::kResidual - kParameters)
                        .template bottomRightCorner<NUM_RESIDUALS, NUM_RESIDUALS>();
    if constexpr (kParameters == 6) {
      // From derivatives by a rotation that follows to derivatives by the rotation vector.
      const Eigen::Matrix3d by_parameters = leftJacobian(p.template head<3>());
      normal.template topRows<3>() =
          by_parameters.transpose() * normal.template topRows<3>().eval();
      normal.template leftCols<3>() = normal.template leftCols<3>().eval() * by_parameters;
    }
    // A square root: the matrix is positive semidefinite except for rounding errors.
    const Eigen::LDLT<Normal> ldlt(normal);
    const Normal root = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                        Normal(ldlt.matrixU()) *
                        Normal(ldlt.transpositionsP() * Normal::Identity());
    r = root.col(kParameters);
    Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, kParameters>> J(jacobian);
    J = root.template leftCols<kParameters>();
    return true;
  }
};

/// Returns false, with the motion unchanged, if the new one is not finite.
bool moveTo(const Eigen::Isometry3d& T_keyframe_cur, ReprojectionProblem& problem) {
  if (!T_keyframe_cur.matrix().allFinite()) return false;
  problem.setMotion(T_keyframe_cur);
  return true;
}

template <int kParameters>
bool minimize(ReprojectionProblem& problem) {
  const Condensed<kParameters> condensed = {problem};
  ceres::TinySolver<Condensed<kParameters>> solver;
  solver.options.max_num_iterations = kMaxMinimizerSteps + 1;  // it counts the start
  solver.options.parameter_tolerance = 1e-7;
  auto parameters = condensed.start();
  solver.Solve(condensed, &parameters);
  return moveTo(condensed.motionAt(parameters), problem);
}

/// A Gauss-Newton step.
template <int kParameters>
bool improve(ReprojectionProblem& problem) {
  constexpr int kFirst = LinearBlock::kResidual - kParameters;
  const auto normal = problem.normalMatrix(problem.motion(), kFirst);
  const Eigen::Matrix<double, kParameters, 1> step =
      normal.template block<kParameters, kParameters>(kFirst, kFirst)
          .ldlt()
          .solve(normal.template block<kParameters, 1>(kFirst, LinearBlock::kResidual));
  const Condensed<kParameters> condensed = {problem};
  return moveTo(condensed.motionAt(condensed.start() - step), problem);
}

bool hasEnough(Unknowns unknowns, const FeatureSet& set) {
  return count(set) >= (unknowns == Unknowns::kMotion ? 3 : 2);  // each gives two equations
}

}  // namespace

bool solve(Unknowns unknowns, const FeatureSet& set, ReprojectionProblem& problem) {
  if (!hasEnough(unknowns, set)) return false;
  problem.select(set);
  return unknowns == Unknowns::kMotion ? minimize<6>(problem) : minimize<3>(problem);
}

bool refine(Unknowns unknowns, const FeatureSet& set, ReprojectionProblem& problem) {
  if (!hasEnough(unknowns, set)) return false;
  for (int i = 0; i < kRefinements; ++i) {
    problem.select(set);
    problem.weigh(kCauchyFactor);
    // Without smooth errors for the motion: a rotation hardly depends on disparities, and needs all
    // features.
    problem.shareErrors(kSharedRatio, unknowns == Unknowns::kMotion ? 0.0 : kSmoothRatio);
    if (!(unknowns == Unknowns::kMotion ? improve<6>(problem) : improve<3>(problem))) return false;
  }
  return true;
}

}  // namespace rotrocc
