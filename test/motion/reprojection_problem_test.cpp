#include "motion/reprojection_problem.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <opencv2/core.hpp>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kNoiseRatio = 3.0;

/// The residual of Eq. 2, keyframe_px - pi(R X_cur + T) [px], where the motion is a local increment
/// on an initial one: R = Exp(p[0..2]) R_0, T = p[3..5].
///
/// Templated for ceres::Jet: the reference that the analytic Jacobians are tested against.
struct ReprojectionResidual {
  StereoCamera camera;
  Eigen::Vector2d keyframe_px;
  Eigen::Vector3d rotated_point;

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    const T point[3] = {T(rotated_point.x()), T(rotated_point.y()), T(rotated_point.z())};
    T moved[3];
    ceres::AngleAxisRotatePoint(p, point, moved);
    const T z = moved[2] + p[5] < T(kMinDepth_m) ? T(kMinDepth_m) : moved[2] + p[5];
    residual[0] = keyframe_px.x() - (camera.fx * (moved[0] + p[3]) / z + camera.cx);
    residual[1] = keyframe_px.y() - (camera.fy * (moved[1] + p[4]) / z + camera.cy);
    return true;
  }
};

/// Residual and Jacobian of ReprojectionResidual at T by automatic differentiation, by a rotation
/// after that of T and by the translation.
struct Automatic {
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> jacobian;

  Automatic(const StereoCamera& camera, const Correspondence& feature, const Eigen::Isometry3d& T) {
    const ceres::AutoDiffCostFunction<ReprojectionResidual, 2, 6> cost(
        new ReprojectionResidual{camera, feature.keyframe_px, T.linear() * feature.point_cur});
    Vector6d parameters;
    parameters << Eigen::Vector3d::Zero(), T.translation();
    const double* blocks[] = {parameters.data()};
    double* jacobians[] = {jacobian.data()};
    cost.Evaluate(blocks, residual.data(), jacobians);
  }
};

/// d pi(R X + T) / d disparity from central differences.
Eigen::Vector2d byDisparity(const StereoCamera& camera,
                            const Correspondence& feature,
                            const Eigen::Isometry3d& T_keyframe_cur) {
  constexpr double kStep_px = 1e-4;
  const auto projected = [&](double disparity_px) {
    const Eigen::Vector3d point = camera.depth(disparity_px) * camera.ray(feature.cur_px);
    return camera.project(T_keyframe_cur * point);
  };
  return (projected(feature.disparity_px + kStep_px) - projected(feature.disparity_px - kStep_px)) /
         (2.0 * kStep_px);
}

TEST(ReprojectionProblemTest, WhiteningMakesTheCovarianceOfAResidualTheIdentity) {
  StereoCamera verged = kittiCamera();
  verged.cx_right -= 8.0;
  for (const StereoCamera& camera : {kittiCamera(), verged}) {
    std::mt19937 generator(3);
    for (const Eigen::Isometry3d& T : someMotions()) {
      const Correspondences features = simulateFeatures(camera, T, 20, {}, generator);
      ReprojectionProblem problem;
      problem.assign({camera, features, kNoiseRatio}, T);
      problem.visit(T, [&](const ReprojectionProblem::Term& term) {
        const Correspondence& feature = features[term.feature];
        const Eigen::Vector2d j = byDisparity(camera, feature, T);
        const Eigen::Matrix2d S =
            Eigen::Matrix2d::Identity() + kNoiseRatio * kNoiseRatio * j * j.transpose();
        const Eigen::Matrix2d W =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(S).operatorInverseSqrt();
        const Automatic automatic(camera, feature, T);
        // The error of central differences is the square of the step, about 1e-7.
        EXPECT_LT((term.residual_px - W * automatic.residual).norm(), 1e-5);
        EXPECT_LT((term.jacobian - W * automatic.jacobian).norm(),
                  1e-6 * automatic.jacobian.norm());
        EXPECT_LT((term.by_disparity - W * j).norm(), 1e-6);
      });
    }
  }
}

/// The squared distance of the likeliest disparity to the measured one plus that of its flow to the
/// measured flow, in units of the flow's variance.
double leastDistance(const Correspondence& feature, const Eigen::Isometry3d& T) {
  const StereoCamera camera = kittiCamera();
  double least = std::numeric_limits<double>::max();
  for (double off_px = -3.0; off_px <= 3.0; off_px += 0.01) {
    const double disparity_px = feature.disparity_px + off_px;
    if (disparity_px < 0.5 * feature.disparity_px) continue;
    const Eigen::Vector3d point = camera.depth(disparity_px) * camera.ray(feature.cur_px);
    const double flow2 = (feature.keyframe_px - camera.project(T * point)).squaredNorm();
    least = std::min(least, flow2 + off_px * off_px / (kNoiseRatio * kNoiseRatio));
  }
  return least;
}

TEST(ReprojectionProblemTest, AResidualIsTheDistanceToBothMeasurements) {
  std::mt19937 generator(5);
  for (const Eigen::Isometry3d& T : someMotions()) {
    const auto features = simulateFeatures(kittiCamera(), T, 20, {0.3, 0.9}, generator);
    ReprojectionProblem problem;
    problem.assign({kittiCamera(), features, kNoiseRatio}, T);
    problem.visit(T, [&](const ReprojectionProblem::Term& term) {
      const double least = leastDistance(features[term.feature], T);
      // After one step, the fit is accurate to some hundredths of a pixel.
      EXPECT_NEAR(term.residual_px.squaredNorm(), least, 0.03 + 0.03 * least);
    });
  }
}

Correspondences behind(const Eigen::Isometry3d& T) {
  return someFeatures(T * motion({0.0, 0.0, 200.0}, {0.0, 0.0, 0.0}));
}

TEST(ReprojectionProblemTest, WithoutNoiseOfDisparitiesItIsThePapersLeastSquares) {
  for (const Eigen::Isometry3d& T_0 : someMotions()) {
    const Eigen::Isometry3d T = T_0 * motion({0.1, -0.05, 0.2}, {0.006, -0.0064, 0.0048});
    for (const Correspondences& features : {someFeatures(T_0), behind(T_0)}) {
      ReprojectionProblem problem;
      problem.assign({kittiCamera(), features, 0.0}, T_0);
      problem.weigh(2.0);
      std::vector<double> errors_px;
      problem.errors(errors_px);
      ReprojectionProblem::NormalMatrix normal = ReprojectionProblem::NormalMatrix::Zero();
      std::size_t next = 0;
      problem.visit(T, [&](const ReprojectionProblem::Term& term) {
        ASSERT_EQ(term.feature, next++);
        const Correspondence& feature = features[term.feature];
        const Automatic automatic(kittiCamera(), feature, T);
        // Both are exact up to the rounding of some dozen operations.
        EXPECT_LT((term.residual_px - automatic.residual).norm(),
                  1e-12 * (1.0 + automatic.residual.norm()));
        EXPECT_LT((term.jacobian - automatic.jacobian).norm(), 1e-8 * automatic.jacobian.norm());
        const double error_px = Automatic(kittiCamera(), feature, T_0).residual.norm();
        EXPECT_NEAR(errors_px[term.feature], error_px, 1e-12 * (1.0 + error_px));
        Eigen::Matrix<double, 2, 8> row;
        row << -term.by_disparity, term.jacobian, term.residual_px;
        normal += term.weight * row.transpose() * row;
      });
      EXPECT_EQ(next, features.size());
      EXPECT_LT((problem.normalMatrix(T, LinearBlock::kBias) - normal).norm(),
                1e-12 * normal.norm());
      EXPECT_NEAR(problem.normalMatrix(T, 7)(7, 7), normal(7, 7), 1e-12 * normal(7, 7));
      ReprojectionProblem::NormalMatrix of_translation = normal;
      of_translation.topRows<4>().setZero();
      of_translation.leftCols<4>().setZero();
      EXPECT_LT((problem.normalMatrix(T, LinearBlock::kTranslation) - of_translation).norm(),
                1e-12 * normal.norm());
    }
  }
}

/// The normal matrix of bias, motion, shared errors and residuals, and its Schur complement.
Eigen::MatrixXd schurComplement(const ReprojectionProblem& problem,
                                const Correspondences& features,
                                double cell_ratio,
                                double smooth_ratio) {
  constexpr auto kCells = static_cast<Eigen::Index>(SharedErrorGrid::kCells);
  constexpr Eigen::Index kErrors = kCells + 3;
  const SharedErrorGrid grid(kittiCamera());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(8 + kErrors, 8 + kErrors);
  problem.visit(problem.motion(), [&](const ReprojectionProblem::Term& term) {
    const std::size_t cell =
        grid.cell(features[term.feature].keyframe_px.x(), features[term.feature].keyframe_px.y());
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(2, 8 + kErrors);
    row.col(0) = -term.by_disparity;
    row.middleCols<6>(1) = term.jacobian;
    row.col(7) = term.residual_px;
    row.col(8 + static_cast<Eigen::Index>(cell)) = term.by_disparity;
    row.rightCols<3>() = term.by_disparity * SharedErrorGrid::smoothErrors(cell).transpose();
    normal += term.weight * row.transpose() * row;
  });
  Eigen::VectorXd inverse_variance =
      Eigen::VectorXd::Constant(kErrors, 1.0 / (cell_ratio * cell_ratio));
  inverse_variance.tail<3>().setConstant(1.0 / (smooth_ratio * smooth_ratio));
  Eigen::MatrixXd errors = normal.bottomRightCorner(kErrors, kErrors);
  errors.diagonal() += inverse_variance;
  const Eigen::MatrixXd mixed = normal.topRightCorner(8, kErrors);
  return normal.topLeftCorner(8, 8) - mixed * errors.ldlt().solve(mixed.transpose());
}

TEST(ReprojectionProblemTest, EliminatesTheErrorsThatNeighborsShare) {
  constexpr int kBias = LinearBlock::kBias;
  for (const Eigen::Isometry3d& T_0 : someMotions()) {
    const Correspondences features = someFeatures(T_0);
    const Eigen::Isometry3d T = T_0 * motion({0.1, -0.05, 0.2}, {0.006, -0.0064, 0.0048});
    ReprojectionProblem problem;
    problem.assign({kittiCamera(), features, kNoiseRatio}, T);
    problem.weigh(2.0);
    const auto without = problem.normalMatrix(T, kBias);
    for (const double ratio : {0.5, 20.0}) {
      for (const double smooth_ratio : {1e-9, 0.7, 10.0}) {
        const auto expected = schurComplement(problem, features, ratio, smooth_ratio);
        problem.shareErrors(ratio, smooth_ratio);
        EXPECT_LT((problem.normalMatrix(T, kBias) - expected).norm(), 1e-9 * expected.norm());
        EXPECT_NEAR(problem.normalMatrix(T, 7)(7, 7), expected(7, 7), 1e-9 * expected(7, 7));
      }
      const auto none = schurComplement(problem, features, ratio, 1e-9);
      problem.shareErrors(ratio, 0.0);
      EXPECT_LT((problem.normalMatrix(T, kBias) - none).norm(), 1e-9 * none.norm());
    }
    problem.shareErrors(0.0, 0.0);
    EXPECT_EQ(problem.normalMatrix(T, kBias), without);
  }
}

/// The inner loops are compiled for several processors.
TEST(ReprojectionProblemTest, IsTheSameForAllProcessors) {
  const Eigen::Isometry3d T = someMotions().back();
  const Correspondences features = someFeatures(T);
  const auto normalMatrix = [&](bool is_optimized) {
    cv::setUseOptimized(is_optimized);
    ReprojectionProblem problem;
    problem.assign({kittiCamera(), features, kNoiseRatio}, T);
    problem.weigh(2.0);
    problem.shareErrors(0.5, 0.7);
    return problem.normalMatrix(T * motion({0.1, 0.0, 0.2}, {0.0, 0.005, 0.0}), LinearBlock::kBias);
  };
  const auto by_any = normalMatrix(false);
  EXPECT_EQ(normalMatrix(true), by_any);
}

}  // namespace
}  // namespace rotrocc
