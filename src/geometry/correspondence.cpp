#include "rotrocc/correspondence.h"

namespace rotrocc {

void triangulate(const StereoCamera& camera, Correspondences& features) {
  for (Correspondence& feature : features) {
    feature.point_cur = camera.depth(feature.disparity_px) * camera.ray(feature.cur_px);
  }
}

}  // namespace rotrocc
