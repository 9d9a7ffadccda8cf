#include "motion/motion_solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ceres/tiny_solver.h>

#include "geometry/image_grid.h"
#include "motion/outlier_rejection.h"

namespace rotrocc {
namespace {

/// Steps of the translation [m] and rotation [rad] smaller than this change no pixel visibly.
constexpr double kParameterTolerance = 1e-7;

constexpr int kMaxIterations = 20;

/// Cells over which the errors of neighbours may be alike.
constexpr int kScatterColumns = 8;
constexpr int kScatterRows = 3;

/// An upper triangular U with U^T U = `normal`, which is positive semidefinite but for rounding.
template <class Matrix>
Matrix rootOf(const Matrix& normal) {
  Matrix U = Matrix::Zero();
  for (Eigen::Index i = 0; i < U.rows(); ++i) {
    const double pivot = normal(i, i) - U.col(i).head(i).squaredNorm();
    if (!(pivot > 0.0)) continue;
    U(i, i) = std::sqrt(pivot);
    for (Eigen::Index j = i + 1; j < U.cols(); ++j) {
      U(i, j) = (normal(i, j) - U.col(i).head(i).dot(U.col(j).head(i))) / U(i, i);
    }
  }
  return U;
}

/// What ceres::TinySolver gets to see of a problem with many residuals: a few that have the same
/// J^T J, J^T r and r^T r, which is all it makes use of. So it needs no memory.
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
    const auto root = rootOf(problem_.normalMatrix(p));
    r = root.col(kParameters);
    Eigen::Map<Eigen::Matrix<double, NUM_RESIDUALS, kParameters>> J(jacobian);
    J = root.template leftCols<kParameters>();
    return true;
  }

 private:
  const ReprojectionProblem<kParameters>& problem_;
};

template <int kParameters>
void minimise(const ReprojectionProblem<kParameters>& problem,
              Eigen::Matrix<double, kParameters, 1>& parameters) {
  ceres::TinySolver<CondensedProblem<kParameters>> solver;
  solver.options.max_num_iterations = kMaxIterations;
  solver.options.parameter_tolerance = kParameterTolerance;
  solver.Solve(CondensedProblem<kParameters>(problem), &parameters);
}

/// One step of Gauss and Newton, for a start near to the minimum.
template <int kParameters>
void improve(const ReprojectionProblem<kParameters>& problem,
             Eigen::Matrix<double, kParameters, 1>& parameters) {
  const auto normal = problem.normalMatrix(parameters);
  const Eigen::Matrix<double, kParameters, kParameters> matrix =
      normal.template topLeftCorner<kParameters, kParameters>();
  parameters -= matrix.ldlt().solve(normal.template topRightCorner<kParameters, 1>());
}

template <std::size_t kCells>
Matrix6d scatterOf(const std::array<Vector6d, kCells>& gradients) {
  Matrix6d sum = Matrix6d::Zero();
  int cells = 0;
  for (const Vector6d& gradient : gradients) {
    if (gradient.isZero(0.0)) continue;
    sum += gradient * gradient.transpose();
    ++cells;
  }
  // The motion was fitted to them, so that they scatter less than the errors do.
  return sum * cells / std::max(1, cells - 6);
}

}  // namespace

void MotionSolver::setNoiseRatio(double noise_ratio) {
  noise_ratio_ = noise_ratio;
  has_fit_ = false;
}

void MotionSolver::setFeatures(const StereoCamera& camera, const Correspondences& features) {
  camera_ = camera;
  features_ = &features;
  has_fit_ = false;
}

const std::vector<FittedFeature>& MotionSolver::fittedAt(const Eigen::Isometry3d& T_prev_cur) {
  if (!has_fit_ || fitted_T_prev_cur_.matrix() != T_prev_cur.matrix()) {
    fitDisparities(camera_, *features_, T_prev_cur, noise_ratio_, fitted_);
    fitted_T_prev_cur_ = T_prev_cur;
    has_fit_ = true;
  }
  return fitted_;
}

bool MotionSolver::solveMotion(const FeatureSet& set,
                               Weights weights,
                               Eigen::Isometry3d& T_prev_cur) {
  if (count(set) < 3) return false;
  motion_problem_.assign(camera_, fittedAt(T_prev_cur), set);
  Vector6d parameters;
  parameters << Eigen::Vector3d::Zero(), T_prev_cur.translation();
  if (weights == Weights::kRobust) {
    motion_problem_.weigh(parameters, robust_weights_);
    improve(motion_problem_, parameters);
  } else {
    minimise(motion_problem_, parameters);
  }
  if (!parameters.allFinite()) return false;

  const Eigen::Matrix3d R = expRotation(parameters.head<3>()) * T_prev_cur.linear();
  T_prev_cur.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T_prev_cur.translation() = parameters.tail<3>();
  return true;
}

bool MotionSolver::solveTranslation(const FeatureSet& set,
                                    Weights weights,
                                    Eigen::Isometry3d& T_prev_cur) {
  if (count(set) < 2) return false;
  translation_problem_.assign(camera_, fittedAt(T_prev_cur), set);
  Eigen::Vector3d translation = T_prev_cur.translation();
  if (weights == Weights::kRobust) {
    translation_problem_.weigh(translation, robust_weights_);
    improve(translation_problem_, translation);
  } else {
    minimise(translation_problem_, translation);
  }
  if (!translation.allFinite()) return false;
  T_prev_cur.translation() = translation;
  return true;
}

void MotionSolver::measureErrors(const Eigen::Isometry3d& T_prev_cur,
                                 std::vector<double>& errors_px) {
  reprojectionErrors(camera_, fittedAt(T_prev_cur), T_prev_cur.translation(), errors_px);
}

MotionSolver::Information MotionSolver::information(const FeatureSet& set,
                                                    const Eigen::Isometry3d& T_prev_cur,
                                                    int estimated_parameters) {
  motion_problem_.assign(camera_, fittedAt(T_prev_cur), set);
  Vector6d parameters;
  parameters << Eigen::Vector3d::Zero(), T_prev_cur.translation();
  motion_problem_.weigh(parameters, robust_weights_);
  const int rows = motion_problem_.residualCount();
  residuals_.resize(static_cast<std::size_t>(rows));
  jacobian_.resize(static_cast<std::size_t>(6 * rows));
  motion_problem_.linearise(parameters, residuals_.data(), jacobian_.data());
  const Eigen::Map<const Eigen::VectorXd> residuals(residuals_.data(), rows);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6>> jacobian(
      jacobian_.data(), rows, 6);

  Information information;
  const ImageGrid grid(camera_, kScatterColumns, kScatterRows);
  std::array<Vector6d, kScatterColumns * kScatterRows> gradients;
  gradients.fill(Vector6d::Zero());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < features_->size(); ++i) {
    if (set[i] == 0) continue;
    // Both have the root of the weight in them.
    Eigen::Matrix<double, 2, 6> J;
    J << jacobian.block<2, 3>(row, 3), jacobian.block<2, 3>(row, 0);
    const Eigen::Vector2d residual = residuals.segment<2>(row);
    const double weight = robust_weights_[static_cast<std::size_t>(row / 2)];
    information.matrix += weight * J.transpose() * J;
    gradients[grid.cell((*features_)[i].cur_px)] += J.transpose() * residual;
    row += 2;
  }
  information.residual_variance = robust_weights_.variance(residuals, estimated_parameters);
  information.scatter = scatterOf(gradients);
  return information;
}

}  // namespace rotrocc
