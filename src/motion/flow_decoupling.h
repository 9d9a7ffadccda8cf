#pragma once

#include <vector>

#include <Eigen/Core>

#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Length [px] of each feature's flow after removing the rotation (Eq. 27, 28), which is the flow
/// caused by the translation alone: |x_keyframe - pi(R x_cur)|.
void decoupledFlow(const StereoCamera& camera,
                   const Correspondences& features,
                   const Eigen::Matrix3d& R_keyframe_cur,
                   std::vector<double>& lengths_px);

/// Length [px] of each feature's measured flow: |x_keyframe - x_cur|.
void coupledFlow(const Correspondences& features, std::vector<double>& lengths_px);

}  // namespace rotrocc
