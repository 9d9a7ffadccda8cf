#include "rotrocc/correspondence.h"

#include <algorithm>

namespace rotrocc {

void triangulate(const StereoCamera& camera, Correspondences& features) {
  const auto has_no_depth = [&](Correspondence& feature) {
    const double depth_m = camera.depth(feature.disparity_px);
    feature.point_cur = depth_m * camera.ray(feature.cur_px);
    return !isUsableDepth(depth_m);
  };
  features.erase(std::remove_if(features.begin(), features.end(), has_no_depth), features.end());
}

}  // namespace rotrocc
