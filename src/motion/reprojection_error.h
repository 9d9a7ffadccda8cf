#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Reprojection error |x_keyframe - pi(R X_cur + T)| of every feature [px] (Eq. 2).
void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px);

}  // namespace rotrocc
