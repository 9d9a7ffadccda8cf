#pragma once

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The gray cameras of KITTI's odometry benchmark: 1241 x 376 px, 0.537 m apart.
inline StereoCamera kittiCamera() {
  StereoCamera camera;
  camera.width = 1241;
  camera.height = 376;
  camera.fx = camera.fy = 718.856;
  camera.cx = camera.cx_right = 607.1928;
  camera.cy = 185.2157;
  camera.baseline_m = 0.537;
  return camera;
}

}  // namespace rotrocc
