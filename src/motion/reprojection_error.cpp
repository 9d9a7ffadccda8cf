#include "motion/reprojection_error.h"

#include <algorithm>
#include <cstddef>

#include "geometry/min_depth.h"

namespace rotrocc {

void reprojectionErrors(const StereoCamera& camera,
                        const Correspondences& features,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        std::vector<double>& errors_px) {
  errors_px.resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    Eigen::Vector3d point = T_keyframe_cur * features[i].point_cur;
    point.z() = std::max(point.z(), kMinDepth_m);
    errors_px[i] = (features[i].keyframe_px - camera.project(point)).norm();
  }
}

}  // namespace rotrocc
