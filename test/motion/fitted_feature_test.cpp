#include "motion/fitted_feature.h"

#include <random>

#include <gtest/gtest.h>

#include "support/simulated_features.h"

namespace rotrocc {
namespace {

constexpr double kNoiseRatio = 3.0;

/// S as defined at fitAt(), with j from central differences.
Eigen::Matrix2d residualCovariance(const StereoCamera& camera,
                                   const Correspondence& feature,
                                   const Eigen::Isometry3d& T_keyframe_cur) {
  constexpr double kStep_px = 1e-4;
  const auto projected = [&](double disparity_px) {
    const Eigen::Vector3d point = camera.depth(disparity_px) * camera.ray(feature.cur_px);
    return camera.project(T_keyframe_cur * point);
  };
  const Eigen::Vector2d j =
      (projected(feature.disparity_px + kStep_px) - projected(feature.disparity_px - kStep_px)) /
      (2.0 * kStep_px);
  return Eigen::Matrix2d::Identity() + kNoiseRatio * kNoiseRatio * j * j.transpose();
}

TEST(FittedFeatureTest, WhiteningMakesTheCovarianceOfAResidualTheIdentity) {
  StereoCamera verged = kittiCamera();
  verged.cx_right -= 8.0;
  for (const StereoCamera& camera : {kittiCamera(), verged}) {
    std::mt19937 generator(3);
    for (const Eigen::Isometry3d& T : someMotions()) {
      for (const Correspondence& feature : simulateFeatures(camera, T, 20, {}, generator)) {
        const Eigen::Matrix2d W = fitDisparity(camera, feature, T, kNoiseRatio).whitening;
        const Eigen::Matrix2d S = residualCovariance(camera, feature, T);
        // The error of central differences is the square of the step, about 1e-7.
        EXPECT_LT((W * S * W - Eigen::Matrix2d::Identity()).norm(), 1e-5);
        EXPECT_LT((W - W.transpose()).norm(), 1e-12);
      }
    }
  }
}

/// The squared distance of a disparity to the measured one plus that of its flow to the measured
/// flow, in units of the flow's variance.
double distanceToMeasurements(const Correspondence& feature,
                              const Eigen::Isometry3d& T,
                              double disparity_px) {
  const StereoCamera camera = kittiCamera();
  const Eigen::Vector3d point = camera.depth(disparity_px) * camera.ray(feature.cur_px);
  const double by_disparity = (disparity_px - feature.disparity_px) / kNoiseRatio;
  return (feature.keyframe_px - camera.project(T * point)).squaredNorm() +
         by_disparity * by_disparity;
}

TEST(FittedFeatureTest, TheFittedDisparityIsTheLikeliest) {
  const StereoCamera camera = kittiCamera();
  std::mt19937 generator(5);
  for (const Eigen::Isometry3d& T : someMotions()) {
    for (const Correspondence& feature : simulateFeatures(camera, T, 20, {0.3, 0.9}, generator)) {
      const FittedFeature fitted = fitDisparity(camera, feature, T, kNoiseRatio);
      const double fitted_px =
          feature.disparity_px * feature.point_cur.norm() / fitted.rotated_point.norm();
      const double least = distanceToMeasurements(feature, T, fitted_px);
      // After two steps, the fit is accurate to some hundredths of a pixel: neither neighbor may
      // be clearly better.
      EXPECT_LT(least, distanceToMeasurements(feature, T, fitted_px - 0.1) + 0.02);
      EXPECT_LT(least, distanceToMeasurements(feature, T, fitted_px + 0.1) + 0.02);
      // The whitened residual equals the remaining distance to both measurements.
      const Eigen::Vector2d residual =
          fitted.whitening *
          (fitted.target_px - camera.project(fitted.rotated_point + T.translation()));
      EXPECT_NEAR(residual.squaredNorm(), least, 0.02 + 0.02 * least);
    }
  }
}

TEST(FittedFeatureTest, AWrongMatchIsNotFittedBeyondTwiceItsDepth) {
  const StereoCamera camera = kittiCamera();
  const Eigen::Isometry3d T = motion({0.0, 0.0, 1.5}, {0.0, 0.0, 0.0});
  for (Correspondence feature : someFeatures(T)) {
    feature.keyframe_px += Eigen::Vector2d(300.0, -200.0);
    const FittedFeature fitted = fitDisparity(camera, feature, T, kNoiseRatio);
    const double stretch = fitted.rotated_point.norm() / feature.point_cur.norm();
    EXPECT_GE(stretch, 0.5 - 1e-9);
    EXPECT_LE(stretch, 2.0 + 1e-9);
    EXPECT_TRUE(fitted.target_px.allFinite());
  }
}

TEST(FittedFeatureTest, ARatioOfZeroIsThePapersLeastSquares) {
  const Eigen::Isometry3d T = motion({0.3, 0.0, 1.0}, {0.0, 0.05, 0.0});
  for (const Correspondence& feature : someFeatures(T)) {
    const FittedFeature fitted = fitDisparity(kittiCamera(), feature, T, 0.0);
    EXPECT_EQ(fitted.whitening, Eigen::Matrix2d::Identity());
    EXPECT_EQ(fitted.target_px, feature.keyframe_px);
    EXPECT_EQ(fitted.rotated_point, T.linear() * feature.point_cur);
  }
}

}  // namespace
}  // namespace rotrocc
