#pragma once

#include <ceres/rotation.h>
#include <Eigen/Core>

#include "geometry/min_depth.h"
#include "motion/fitted_feature.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The residual of Eq. 2 for one fitted feature, W (target - pi(R X_cur + T)) [px], where the
/// motion is a local increment on an initial one: R = Exp(p[0..2]) R_0, T = p[3..5].
///
/// Templated for ceres::Jet: the reference that the analytic Jacobians are tested against.
struct ReprojectionResidual {
  StereoCamera camera;
  FittedFeature feature;

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    const T point[3] = {
        T(feature.rotated_point.x()), T(feature.rotated_point.y()), T(feature.rotated_point.z())};
    T moved[3];
    ceres::AngleAxisRotatePoint(p, point, moved);
    const T z = moved[2] + p[5] < T(kMinDepth_m) ? T(kMinDepth_m) : moved[2] + p[5];
    const T x = feature.target_px.x() - (camera.fx * (moved[0] + p[3]) / z + camera.cx);
    const T y = feature.target_px.y() - (camera.fy * (moved[1] + p[4]) / z + camera.cy);
    const Eigen::Matrix2d& W = feature.whitening;
    residual[0] = W(0, 0) * x + W(0, 1) * y;
    residual[1] = W(1, 0) * x + W(1, 1) * y;
    return true;
  }
};

}  // namespace rotrocc
