#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "motion/fitted_feature.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Reprojection error |x_keyframe - pi(R X_cur + T)| of each feature [px] (Eq. 2).
void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px);

/// Whitened reprojection errors |W (target - pi(R X_cur + T))| [px], at the motion of the fit.
void fittedErrors(const StereoCamera& camera, const Fit& fit, std::vector<double>& errors_px);

/// Length [px] of each feature's flow after removing the rotation (Eq. 27, 28), which is the flow
/// caused by the translation alone: |x_keyframe - pi(R x_cur)|.
void decoupledFlow(const StereoCamera& camera,
                   const Correspondences& features,
                   const Eigen::Matrix3d& R_keyframe_cur,
                   std::vector<double>& lengths_px);

/// Length [px] of each feature's measured flow: |x_keyframe - x_cur|.
void coupledFlow(const Correspondences& features, std::vector<double>& lengths_px);

}  // namespace rotrocc
