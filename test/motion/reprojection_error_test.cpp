#include "motion/reprojection_error.h"

#include <cmath>
#include <memory>
#include <random>

#include <ceres/ceres.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "rotrocc/rigid_motion.h"
#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kNoiseRatio = 3.0;

/// Motions of a car and of a hand-held camera, some with no rotation or translation at all.
std::vector<Eigen::Isometry3d> someMotions() {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto vector = [&] {
    return Eigen::Vector3d(any(generator), any(generator), any(generator));
  };
  std::vector<Eigen::Isometry3d> motions = {motion({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}),
                                            motion({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0}),
                                            motion({0.0, 0.0, 0.0}, {0.0, 0.1, 0.0})};
  for (int i = 0; i < 10; ++i) motions.push_back(motion(vector(), 0.2 * vector()));
  return motions;
}

Correspondences someFeatures(const Eigen::Isometry3d& T_prev_cur) {
  std::mt19937 generator(2);
  return simulateFeatures(kittiCamera(), T_prev_cur, 20, {5.0, 1.0}, generator);
}

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

/// The step from T_0 at which the Jacobians are compared: rotation, then the translation itself.
Vector6d parametersNear(const Eigen::Isometry3d& T_0, const Eigen::Vector3d& rotation_rad) {
  Vector6d parameters;
  parameters << rotation_rad, T_0.translation() + Eigen::Vector3d(0.1, -0.05, 0.2);
  return parameters;
}

template <int kParameters>
void expectAutomaticJacobian(const Eigen::Isometry3d& T_0,
                             const Correspondences& features,
                             double noise_ratio,
                             const Vector6d& parameters) {
  ReprojectionProblem<kParameters> problem;
  problem.assign(kittiCamera(), features, FeatureSet(features.size(), 1), T_0, noise_ratio);
  ASSERT_EQ(problem.residualCount(), static_cast<int>(2 * features.size()));
  Eigen::VectorXd residuals(problem.residualCount());
  Eigen::Matrix<double, Eigen::Dynamic, kParameters> jacobian(problem.residualCount(), kParameters);
  const Eigen::Matrix<double, kParameters, 1> own = parameters.template tail<kParameters>();
  problem.linearise(own, residuals.data(), jacobian.data());
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Automatic automatic(features[i], T_0, noise_ratio, parameters);
    const auto row = static_cast<Eigen::Index>(2 * i);
    const Eigen::Matrix<double, 2, kParameters> expected =
        automatic.jacobian.template rightCols<kParameters>();
    // Both are exact; they differ by the rounding of some dozen operations.
    EXPECT_LT((residuals.segment<2>(row) - automatic.residual).norm(), 1e-9);
    EXPECT_LT((jacobian.template middleRows<2>(row) - expected).norm(), 1e-8 * expected.norm());
  }
  Eigen::Matrix<double, Eigen::Dynamic, kParameters + 1> both(problem.residualCount(),
                                                              kParameters + 1);
  both << jacobian, residuals;
  const auto normal = (both.transpose() * both).eval();
  EXPECT_LT((problem.normalMatrix(own) - normal).norm(), 1e-12 * normal.norm());
  EXPECT_NEAR(problem.cost(own), residuals.squaredNorm(), 1e-12 * residuals.squaredNorm());
}

TEST(ReprojectionErrorTest, AnalyticJacobiansEqualAutomaticOnes) {
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

TEST(ReprojectionErrorTest, JacobiansHoldForPointsBehindTheCameraToo) {
  const Eigen::Isometry3d T_0 = motion({0.0, 0.0, -200.0}, {0.0, 0.02, 0.0});
  const Correspondences features = someFeatures(Eigen::Isometry3d::Identity());
  expectAutomaticJacobian<6>(T_0, features, 0.0, parametersNear(T_0, {0.01, 0.0, 0.0}));
  expectAutomaticJacobian<3>(T_0, features, 0.0, parametersNear(T_0, {0.0, 0.0, 0.0}));
}

TEST(ReprojectionErrorTest, TheProblemTakesOnlyTheFeaturesOfTheSet) {
  const Eigen::Isometry3d T = motion({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0});
  const Correspondences features = someFeatures(T);
  FeatureSet set(features.size(), 0);
  set[3] = set[7] = 1;
  ReprojectionProblem<3> problem;
  problem.assign(kittiCamera(), features, set, T, 0.0);
  ASSERT_EQ(problem.residualCount(), 4);
  Eigen::Vector4d residuals;
  Eigen::Matrix<double, 4, 3> jacobian;
  problem.linearise(T.translation(), residuals.data(), jacobian.data());
  const StereoCamera camera = kittiCamera();
  const Eigen::Vector2d second =
      features[7].prev_px - camera.project(T * features[7].point_cur);  // Eq. 2
  EXPECT_LT((residuals.tail<2>() - second).norm(), 1e-9);
}

/// S of the docstring of fitDisparities(), with j by central differences.
Eigen::Matrix2d residualCovariance(const StereoCamera& camera,
                                   const Correspondence& feature,
                                   const Eigen::Isometry3d& T_prev_cur) {
  constexpr double kStep_px = 1e-4;
  const auto projected = [&](double disparity_px) {
    const Eigen::Vector3d point = camera.depth(disparity_px) * camera.ray(feature.cur_px);
    return camera.project(T_prev_cur * point);
  };
  const Eigen::Vector2d j =
      (projected(feature.disparity_px + kStep_px) - projected(feature.disparity_px - kStep_px)) /
      (2.0 * kStep_px);
  return Eigen::Matrix2d::Identity() + kNoiseRatio * kNoiseRatio * j * j.transpose();
}

TEST(ReprojectionErrorTest, WhiteningMakesTheCovarianceOfAResidualTheIdentity) {
  StereoCamera verged = kittiCamera();
  verged.cx_right -= 8.0;
  for (const StereoCamera& camera : {kittiCamera(), verged}) {
    std::mt19937 generator(3);
    for (const Eigen::Isometry3d& T : someMotions()) {
      for (const Correspondence& feature : simulateFeatures(camera, T, 20, {}, generator)) {
        const Eigen::Matrix2d W = fitDisparity(camera, feature, T, kNoiseRatio).whitening;
        const Eigen::Matrix2d S = residualCovariance(camera, feature, T);
        // Central differences are good to the square of the step, some 1e-7.
        EXPECT_LT((W * S * W - Eigen::Matrix2d::Identity()).norm(), 1e-5);
        EXPECT_LT((W - W.transpose()).norm(), 1e-12);
      }
    }
  }
}

/// Squared distance of a disparity to the measured one and of its flow to the measured flow, in
/// units of the flow's variance.
double distanceToMeasurements(const Correspondence& feature,
                              const Eigen::Isometry3d& T,
                              double disparity_px) {
  const StereoCamera camera = kittiCamera();
  const Eigen::Vector3d point = camera.depth(disparity_px) * camera.ray(feature.cur_px);
  const double by_disparity = (disparity_px - feature.disparity_px) / kNoiseRatio;
  return (feature.prev_px - camera.project(T * point)).squaredNorm() + by_disparity * by_disparity;
}

TEST(ReprojectionErrorTest, TheFittedDisparityIsTheLikeliest) {
  const StereoCamera camera = kittiCamera();
  std::mt19937 generator(5);
  for (const Eigen::Isometry3d& T : someMotions()) {
    for (const Correspondence& feature : simulateFeatures(camera, T, 20, {0.3, 0.9}, generator)) {
      const FittedFeature fitted = fitDisparity(camera, feature, T, kNoiseRatio);
      const double fitted_px =
          feature.disparity_px * feature.point_cur.norm() / fitted.rotated_point.norm();
      const double least = distanceToMeasurements(feature, T, fitted_px);
      // Two steps of a fit leave some hundredths of a pixel: neither neighbour is clearly better.
      EXPECT_LT(least, distanceToMeasurements(feature, T, fitted_px - 0.1) + 0.02);
      EXPECT_LT(least, distanceToMeasurements(feature, T, fitted_px + 0.1) + 0.02);
      // The whitened residual is what the fit leaves of both.
      const Eigen::Vector2d residual =
          fitted.whitening *
          (fitted.target_px - camera.project(fitted.rotated_point + T.translation()));
      EXPECT_NEAR(residual.squaredNorm(), least, 0.02 + 0.02 * least);
    }
  }
}

TEST(ReprojectionErrorTest, AWrongMatchIsNotFittedBeyondTwiceItsDepth) {
  const StereoCamera camera = kittiCamera();
  const Eigen::Isometry3d T = motion({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0});
  for (Correspondence feature : someFeatures(T)) {
    feature.prev_px += Eigen::Vector2d(300.0, -200.0);
    const FittedFeature fitted = fitDisparity(camera, feature, T, kNoiseRatio);
    const double stretch = fitted.rotated_point.norm() / feature.point_cur.norm();
    EXPECT_GE(stretch, 0.5 - 1e-9);
    EXPECT_LE(stretch, 2.0 + 1e-9);
    EXPECT_TRUE(fitted.target_px.allFinite());
  }
}

TEST(ReprojectionErrorTest, WhiteningTellsNearPointsFromFarOnes) {
  const StereoCamera camera = kittiCamera();
  const Eigen::Isometry3d T = motion({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0});
  const auto weight = [&](double depth_m) {
    Correspondence feature;
    std::mt19937 generator(4);
    EXPECT_TRUE(measure(camera, {2.0, 1.0, depth_m}, T, {}, generator, feature));
    return fitDisparity(camera, feature, T, kNoiseRatio).whitening.determinant();
  };
  EXPECT_LT(weight(4.0), 0.5 * weight(40.0));
}

TEST(ReprojectionErrorTest, ARatioOfZeroIsThePapersLeastSquares) {
  const Eigen::Isometry3d T = motion({0.3, 0.0, 1.0}, {0.0, 0.05, 0.0});
  for (const Correspondence& feature : someFeatures(T)) {
    const FittedFeature fitted = fitDisparity(kittiCamera(), feature, T, 0.0);
    EXPECT_EQ(fitted.whitening, Eigen::Matrix2d::Identity());
    EXPECT_EQ(fitted.target_px, feature.prev_px);
    EXPECT_EQ(fitted.rotated_point, T.linear() * feature.point_cur);
  }
}

TEST(ReprojectionErrorTest, APureRotationNeedsNoDepth) {
  const Eigen::Isometry3d T = motion({0.0, 0.0, 0.0}, {0.01, 0.05, -0.02});
  for (const Correspondence& feature : someFeatures(T)) {
    const FittedFeature fitted = fitDisparity(kittiCamera(), feature, T, kNoiseRatio);
    EXPECT_LT((fitted.whitening - Eigen::Matrix2d::Identity()).norm(), 1e-9);
    EXPECT_LT((fitted.target_px - feature.prev_px).norm(), 1e-9);
  }
}

TEST(ReprojectionErrorTest, AFitDependsNeitherOnItsNeighboursNorOnTheProcessor) {
  const Eigen::Isometry3d T = motion({0.3, 0.0, 1.0}, {0.0, 0.05, 0.0});
  Correspondences features = someFeatures(T);
  ASSERT_GT(features.size(), 17U);
  for (const std::size_t count : {17U, 16U, 15U, 1U}) {
    features.resize(count);
    std::vector<FittedFeature> fitted, plain;
    fitDisparities(kittiCamera(), features, T, kNoiseRatio, fitted);
    cv::setUseOptimized(false);
    fitDisparities(kittiCamera(), features, T, kNoiseRatio, plain);
    cv::setUseOptimized(true);
    ASSERT_EQ(fitted.size(), count);
    ASSERT_EQ(plain.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      const FittedFeature alone = fitDisparity(kittiCamera(), features[i], T, kNoiseRatio);
      for (const FittedFeature& other : {alone, plain[i]}) {
        EXPECT_EQ(fitted[i].target_px, other.target_px);
        EXPECT_EQ(fitted[i].rotated_point, other.rotated_point);
        EXPECT_EQ(fitted[i].whitening, other.whitening);
        EXPECT_EQ(fitted[i].by_disparity, other.by_disparity);
      }
    }
  }
}

TEST(ReprojectionErrorTest, ErrorsAreTheLengthsOfTheResiduals) {
  const Eigen::Isometry3d T = motion({0.3, 0.0, 1.0}, {0.0, 0.05, 0.0});
  const Correspondences features = someFeatures(T);
  const StereoCamera camera = kittiCamera();
  for (const double noise_ratio : {0.0, kNoiseRatio}) {
    std::vector<FittedFeature> fitted;
    fitDisparities(camera, features, T, noise_ratio, fitted);
    std::vector<double> errors_px;
    reprojectionErrors(camera, fitted, T.translation(), errors_px);
    ASSERT_EQ(errors_px.size(), features.size());
    for (std::size_t i = 0; i < features.size(); ++i) {
      Vector6d parameters;
      parameters << 0.0, 0.0, 0.0, T.translation();
      const Automatic automatic(features[i], T, noise_ratio, parameters);
      EXPECT_NEAR(errors_px[i], automatic.residual.norm(), 1e-9);
    }
    if (noise_ratio > 0.0) continue;
    std::vector<double> plain_px;
    reprojectionErrors(camera, features, T, plain_px);
    for (std::size_t i = 0; i < features.size(); ++i) EXPECT_NEAR(plain_px[i], errors_px[i], 1e-9);
  }
}

}  // namespace
}  // namespace rotrocc
