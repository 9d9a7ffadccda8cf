#include "rotrocc/motion_solver.h"

#include <algorithm>
#include <array>

#include "image_grid.h"
#include "rotrocc/outlier_rejection.h"

namespace rotrocc {
namespace {

/// Steps of the translation [m] and rotation [rad] smaller than this change no pixel visibly.
constexpr double kParameterTolerance = 1e-7;

constexpr int kMaxIterations = 20;

/// Cells over which the errors of neighbours may be alike.
constexpr int kScatterColumns = 8;
constexpr int kScatterRows = 3;

template <class Solver>
void configure(Solver& solver) {
  solver.options.max_num_iterations = kMaxIterations;
  solver.options.parameter_tolerance = kParameterTolerance;
}

}  // namespace

bool MotionSolver::solveMotion(const StereoCamera& camera,
                               const Correspondences& features,
                               const FeatureSet& set,
                               Eigen::Isometry3d& T_prev_cur) {
  if (count(set) < 3) return false;
  motion_problem_.assign(camera, features, set, T_prev_cur, noise_ratio_);
  Vector6d parameters;
  parameters << Eigen::Vector3d::Zero(), T_prev_cur.translation();
  configure(motion_solver_);
  motion_solver_.Solve(motion_problem_, &parameters);
  if (!parameters.allFinite()) return false;

  const Eigen::Matrix3d R = expRotation(parameters.head<3>()) * T_prev_cur.linear();
  T_prev_cur.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T_prev_cur.translation() = parameters.tail<3>();
  return true;
}

bool MotionSolver::solveTranslation(const StereoCamera& camera,
                                    const Correspondences& features,
                                    const FeatureSet& set,
                                    Eigen::Isometry3d& T_prev_cur) {
  if (count(set) < 2) return false;
  translation_problem_.assign(camera, features, set, T_prev_cur, noise_ratio_);
  Eigen::Vector3d translation = T_prev_cur.translation();
  configure(translation_solver_);
  translation_solver_.Solve(translation_problem_, &translation);
  if (!translation.allFinite()) return false;
  T_prev_cur.translation() = translation;
  return true;
}

MotionSolver::Information MotionSolver::information(const StereoCamera& camera,
                                                    const Correspondences& features,
                                                    const FeatureSet& set,
                                                    const Eigen::Isometry3d& T_prev_cur,
                                                    int estimated_parameters) {
  motion_problem_.assign(camera, features, set, T_prev_cur, noise_ratio_);
  Vector6d parameters;
  parameters << Eigen::Vector3d::Zero(), T_prev_cur.translation();
  residuals_.resize(motion_problem_.NumResiduals());
  jacobian_.resize(motion_problem_.NumResiduals(), 6);
  motion_problem_(parameters.data(), residuals_.data(), jacobian_.data());

  Information information;
  const auto rotation = jacobian_.leftCols<3>();
  const auto translation = jacobian_.rightCols<3>();
  information.matrix.topLeftCorner<3, 3>() = translation.transpose() * translation;
  information.matrix.topRightCorner<3, 3>() = translation.transpose() * rotation;
  information.matrix.bottomLeftCorner<3, 3>() = rotation.transpose() * translation;
  information.matrix.bottomRightCorner<3, 3>() = rotation.transpose() * rotation;
  const auto freedom = static_cast<double>(residuals_.size() - estimated_parameters);
  if (freedom > 0.0) information.residual_variance = residuals_.squaredNorm() / freedom;
  information.scatter = scatter(camera, features, set);
  return information;
}

Matrix6d MotionSolver::scatter(const StereoCamera& camera,
                               const Correspondences& features,
                               const FeatureSet& set) const {
  const ImageGrid grid(camera, kScatterColumns, kScatterRows);
  std::array<Vector6d, kScatterColumns * kScatterRows> gradients;
  gradients.fill(Vector6d::Zero());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (set[i] == 0) continue;
    Vector6d& gradient = gradients[grid.cell(features[i].cur_px)];
    const auto J = jacobian_.middleRows<2>(row);
    const auto residual = residuals_.segment<2>(row);
    gradient.head<3>() += J.rightCols<3>().transpose() * residual;
    gradient.tail<3>() += J.leftCols<3>().transpose() * residual;
    row += 2;
  }
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

}  // namespace rotrocc
