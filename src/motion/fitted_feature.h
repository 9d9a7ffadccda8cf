#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What is measured of one pair, and how noisy.
struct Measurements {
  const StereoCamera& camera;
  const Correspondences& features;
  double noise_ratio;  ///< standard deviation of a disparity over that of a flow
};

/// A feature as least squares over the motion alone may see it, although its disparity is noisy
/// too.
struct FittedFeature {
  Eigen::Vector2d target_px;      ///< what the projection should hit, in the keyframe
  Eigen::Vector3d rotated_point;  ///< R X_cur of the fitted disparity [m]
  Eigen::Matrix2d whitening;      ///< of target_px - pi(R X_cur + T), to unit variance of a flow
  Eigen::Vector2d by_disparity;   ///< d pi(R X_cur + T) / d disparity, at the motion
};

/// All features of a pair, fitted at a motion.
struct Fit {
  Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
  std::vector<FittedFeature> features;
};

/// Fits the features' disparities to both their measurements: themselves and, at the motion, their
/// flow. With r = `noise_ratio` and j = d pi(R X + T) / d disparity at the fitted disparity, the
/// residual's covariance is S = I + r^2 j j^T in units of the flow's variance, of which `whitening`
/// is the inverse root; the target is prev_px, moved to where it would be expected had the measured
/// disparity been the fitted one. The least squares of such residuals have their minimum where
/// those over motion and all true disparities have it (Deming's regression): taken at the measured
/// disparities, noisy far points would pull the motion towards too short. A ratio of 0 changes
/// nothing: the paper's least squares.
void fitAt(const Measurements& measured, const Eigen::Isometry3d& T_prev_cur, Fit& fit);

/// Whitened reprojection errors |W (target - pi(R X_cur + T))| of all features [px], at the motion
/// that they are fitted at.
void fittedErrors(const StereoCamera& camera, const Fit& fit, std::vector<double>& errors_px);

}  // namespace rotrocc
