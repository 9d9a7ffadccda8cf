#include "motion/flow_decoupling.h"

#include <algorithm>

#include "geometry/min_depth.h"

namespace rotrocc {

void decoupledFlow(const StereoCamera& camera,
                   const Correspondences& features,
                   const Eigen::Matrix3d& R_keyframe_cur,
                   std::vector<double>& lengths_px) {
  lengths_px.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    Eigen::Vector3d rotated = R_keyframe_cur * features[i].point_cur;  // Eq. 27
    rotated.z() = std::max(rotated.z(), kMinDepth_m);
    lengths_px[i] = (features[i].keyframe_px - camera.project(rotated)).norm();  // Eq. 28
  }
}

void coupledFlow(const Correspondences& features, std::vector<double>& lengths_px) {
  lengths_px.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    lengths_px[i] = (features[i].keyframe_px - features[i].cur_px).norm();
  }
}

}  // namespace rotrocc
