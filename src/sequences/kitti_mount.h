#pragma once

#include <Eigen/Geometry>

namespace rotrocc {

/// T_base_camera of a base that is at the camera, with x forward and z up (REP 103).
inline Eigen::Isometry3d mountAtCamera() {
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_base_camera;
}

/// T_base_camera of KITTI's left gray camera: 1.65 m above the road, looking along the vehicle's x
/// axis (cvlibs.net/datasets/kitti/setup.php). base_link is on the road below it.
inline Eigen::Isometry3d kittiMount() {
  return Eigen::Translation3d(0.0, 0.0, 1.65) * mountAtCamera();
}

}  // namespace rotrocc
