#pragma once

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// KITTI's grey cameras at a quarter of their size.
inline StereoCamera smallCamera() {
  StereoCamera camera;
  camera.width = 310;
  camera.height = 94;
  camera.fx = camera.fy = 180.0;
  camera.cx = camera.cx_right = 152.0;
  camera.cy = 46.0;
  camera.baseline_m = 0.537;
  return camera;
}

}  // namespace rotrocc
