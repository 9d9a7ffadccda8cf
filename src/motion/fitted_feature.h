#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kernels/feature_kernels.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Standard deviation of a disparity over that of a flow.
constexpr double kDisparityNoiseRatio = 4.0;

/// The measurements of one pair and their noise.
struct Measurements {
  const StereoCamera& camera;
  const Correspondences& features;
  double noise_ratio;  ///< standard deviation of a disparity over that of a flow
};

/// A feature with its disparity fitted, so that least squares over the motion alone also account
/// for the disparity noise.
struct FittedFeature {
  Eigen::Vector2d target_px;      ///< target of the projection, in the keyframe
  Eigen::Vector3d rotated_point;  ///< R X_cur at the fitted disparity [m]
  Eigen::Matrix2d whitening;  ///< whitens target_px - pi(R X_cur + T) to the variance of the flow
  Eigen::Vector2d by_disparity;  ///< d pi(R X_cur + T) / d disparity, at the motion
};

/// All features of a pair, fitted at a motion.
struct Fit {
  Eigen::Isometry3d T_keyframe_cur = Eigen::Isometry3d::Identity();
  std::vector<FittedFeature> features;
};

/// For the kernels.
MotionTerms termsAt(const StereoCamera& camera, const Eigen::Isometry3d& T_keyframe_cur);

/// Fits each feature's disparity to the measured disparity and, at the given motion, to the
/// measured flow.
///
/// With r = `noise_ratio` and j = d pi(R X + T) / d disparity at the fitted disparity, the
/// covariance of the residual is S = I + r^2 j j^T in units of the flow's variance; `whitening` is
/// S^-1/2. The target is keyframe_px, shifted by the predicted effect of replacing the measured by
/// the fitted disparity. Least squares of these residuals have the same minimum as least squares
/// over the motion and all true disparities (Deming regression). With the measured disparities,
/// noisy far points would bias the translation towards zero. A ratio of 0 gives the paper's least
/// squares.
void fitAt(const Measurements& measured, const Eigen::Isometry3d& T_keyframe_cur, Fit& fit);

}  // namespace rotrocc
