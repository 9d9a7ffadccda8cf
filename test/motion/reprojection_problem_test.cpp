#include "motion/reprojection_problem.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kNoiseRatio = 3.0;

/// The residual of Eq. 2 for one fitted feature, W (target - pi(R X_cur + T)) [px], where the
/// motion is a local increment on an initial one: R = Exp(p[0..2]) R_0, T = p[3..5].
///
/// Templated for ceres::Jet: the reference that the analytic Jacobians are tested against.
struct ReprojectionResidual {
  StereoCamera camera;
  FittedFeature feature;

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    const T point[3] = {
        T(feature.rotated_point.x()), T(feature.rotated_point.y()), T(feature.rotated_point.z())};
    T moved[3];
    ceres::AngleAxisRotatePoint(p, point, moved);
    const T z = moved[2] + p[5] < T(kMinDepth_m) ? T(kMinDepth_m) : moved[2] + p[5];
    const T x = feature.target_px.x() - (camera.fx * (moved[0] + p[3]) / z + camera.cx);
    const T y = feature.target_px.y() - (camera.fy * (moved[1] + p[4]) / z + camera.cy);
    const Eigen::Matrix2d& W = feature.whitening;
    residual[0] = W(0, 0) * x + W(0, 1) * y;
    residual[1] = W(1, 0) * x + W(1, 1) * y;
    return true;
  }
};

/// Residuals and Jacobian of ReprojectionResidual by automatic differentiation, 6 parameters.
struct Automatic {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> jacobian;

  Automatic(const Correspondence& feature,
            const Eigen::Isometry3d& T_0,
            double noise_ratio,
            const Vector6d& parameters) {
    const StereoCamera camera = kittiCamera();
    const ceres::AutoDiffCostFunction<ReprojectionResidual, 2, 6> cost(
        new ReprojectionResidual{camera, fitDisparity(camera, feature, T_0, noise_ratio)});
    const double* blocks[] = {parameters.data()};
    double* jacobians[] = {jacobian.data()};
    cost.Evaluate(blocks, residual.data(), jacobians);
  }
};

/// The parameters at which the Jacobians are compared: the rotation from T_0, then the translation.
Vector6d parametersNear(const Eigen::Isometry3d& T_0, const Eigen::Vector3d& rotation_rad) {
  Vector6d parameters;
  parameters << rotation_rad, T_0.translation() + Eigen::Vector3d(0.1, -0.05, 0.2);
  return parameters;
}

Fit fitOf(const Correspondences& features, const Eigen::Isometry3d& T_0, double noise_ratio) {
  const StereoCamera camera = kittiCamera();
  Fit fit;
  fitAt({camera, features, noise_ratio}, T_0, fit);
  return fit;
}

template <int kParameters>
void expectAutomaticJacobian(const Eigen::Isometry3d& T_0,
                             const Correspondences& features,
                             double noise_ratio,
                             const Vector6d& parameters) {
  using Problem = ReprojectionProblem<kParameters>;
  Problem problem;
  problem.assign(kittiCamera(), fitOf(features, T_0, noise_ratio), all(features));
  const typename Problem::Parameters own = parameters.template tail<kParameters>();
  problem.weigh(own, 2.0);
  const Eigen::Matrix3d by_rotation = leftJacobian(parameters.head<3>());
  std::size_t next = 0;
  typename Problem::NormalMatrix normal = Problem::NormalMatrix::Zero();
  problem.linearize(own, [&](const typename Problem::Term& term) {
    ASSERT_EQ(term.feature, next++);
    const Automatic automatic(features[term.feature], T_0, noise_ratio, parameters);
    // Both are exact up to the rounding of some dozen operations.
    EXPECT_LT((term.residual_px - automatic.residual).norm(), 1e-9);
    const Eigen::Matrix<double, 2, kParameters> expected =
        automatic.jacobian.template rightCols<kParameters>();
    Eigen::Matrix<double, 2, kParameters> jacobian = term.jacobian;
    if (kParameters == 6) jacobian.template leftCols<3>() *= by_rotation;
    EXPECT_LT((jacobian - expected).norm(), 1e-8 * expected.norm());
    Eigen::Matrix<double, 2, kParameters + 1> both;
    both << jacobian, term.residual_px;
    normal += term.weight * both.transpose() * both;
  });
  EXPECT_EQ(next, features.size());
  EXPECT_LT((problem.normalMatrix(own) - normal).norm(), 1e-12 * normal.norm());
  const double cost = normal(kParameters, kParameters);
  EXPECT_NEAR(problem.cost(own), cost, 1e-12 * cost);
}

TEST(ReprojectionProblemTest, AnalyticJacobiansEqualAutomaticOnes) {
  for (const Eigen::Isometry3d& T_0 : someMotions()) {
    const Correspondences features = someFeatures(T_0);
    for (const double noise_ratio : {0.0, kNoiseRatio}) {
      for (const double angle_rad : {0.0, 1e-6, 0.01, 0.3}) {
        const Eigen::Vector3d rotation_rad = angle_rad * Eigen::Vector3d(0.6, -0.64, 0.48);
        expectAutomaticJacobian<6>(T_0, features, noise_ratio, parametersNear(T_0, rotation_rad));
      }
      expectAutomaticJacobian<3>(
          T_0, features, noise_ratio, parametersNear(T_0, Eigen::Vector3d::Zero()));
    }
  }
}

TEST(ReprojectionProblemTest, JacobiansHoldForPointsBehindTheCameraToo) {
  const Eigen::Isometry3d T_0 = motion({0.0, 0.0, -200.0}, {0.0, 0.02, 0.0});
  const Correspondences features = someFeatures(Eigen::Isometry3d::Identity());
  expectAutomaticJacobian<6>(T_0, features, 0.0, parametersNear(T_0, {0.01, 0.0, 0.0}));
  expectAutomaticJacobian<3>(T_0, features, 0.0, parametersNear(T_0, {0.0, 0.0, 0.0}));
}

/// The normal matrix of motion, shared errors and residuals, and its Schur complement.
Eigen::MatrixXd schurComplement(const ReprojectionProblem<6>& problem,
                                const Vector6d& parameters,
                                double cell_ratio,
                                double parabola_ratio) {
  constexpr auto kCells = static_cast<Eigen::Index>(SharedErrorGrid::kCells);
  constexpr Eigen::Index kErrors = kCells + 1;
  const Eigen::Matrix3d by_rotation = leftJacobian(parameters.head<3>());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(7 + kErrors, 7 + kErrors);
  problem.linearize(parameters, [&](const ReprojectionProblem<6>::Term& term) {
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(2, 7 + kErrors);
    row.leftCols<6>() = term.jacobian;
    row.leftCols<3>() = term.jacobian.leftCols<3>() * by_rotation;
    row.col(6) = term.residual_px;
    row.col(7 + static_cast<Eigen::Index>(term.cell)) = term.by_disparity;
    row.col(7 + kCells) = term.parabola * term.by_disparity;
    normal += term.weight * row.transpose() * row;
  });
  Eigen::VectorXd inverse_variance =
      Eigen::VectorXd::Constant(kErrors, 1.0 / (cell_ratio * cell_ratio));
  inverse_variance[kCells] = 1.0 / (parabola_ratio * parabola_ratio);
  Eigen::MatrixXd errors = normal.bottomRightCorner(kErrors, kErrors);
  errors.diagonal() += inverse_variance;
  const Eigen::MatrixXd mixed = normal.topRightCorner(7, kErrors);
  return normal.topLeftCorner(7, 7) - mixed * errors.ldlt().solve(mixed.transpose());
}

TEST(ReprojectionProblemTest, EliminatesTheErrorsThatNeighborsShare) {
  for (const Eigen::Isometry3d& T_0 : someMotions()) {
    const Correspondences features = someFeatures(T_0);
    const Vector6d parameters = parametersNear(T_0, {0.006, -0.0064, 0.0048});
    ReprojectionProblem<6> problem;
    problem.assign(kittiCamera(), fitOf(features, T_0, kNoiseRatio), all(features));
    problem.weigh(parameters, 2.0);
    for (const double ratio : {0.5, 20.0}) {
      for (const double parabola_ratio : {1e-9, 0.7, 10.0}) {
        const auto expected = schurComplement(problem, parameters, ratio, parabola_ratio);
        problem.shareErrors(ratio, parabola_ratio);
        EXPECT_LT((problem.normalMatrix(parameters) - expected).norm(), 1e-9 * expected.norm());
        EXPECT_NEAR(problem.cost(parameters), expected(6, 6), 1e-9 * expected(6, 6));
      }
      const auto none = schurComplement(problem, parameters, ratio, 1e-9);
      problem.shareErrors(ratio, 0.0);
      EXPECT_LT((problem.normalMatrix(parameters) - none).norm(), 1e-9 * none.norm());
    }
    problem.shareErrors(0.0, 0.0);
    ReprojectionProblem<6> without;
    without.assign(kittiCamera(), fitOf(features, T_0, kNoiseRatio), all(features));
    without.weigh(parameters, 2.0);
    EXPECT_EQ(problem.normalMatrix(parameters), without.normalMatrix(parameters));
  }
}

}  // namespace
}  // namespace rotrocc
