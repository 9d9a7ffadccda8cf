#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// One feature of the set F = {x_keyframe, x_cur, depth} (paper, section V-A), in left pixels.
struct Correspondence {
  Eigen::Vector2d keyframe_px = Eigen::Vector2d::Zero();  ///< measured in the keyframe
  Eigen::Vector2d cur_px = Eigen::Vector2d::Zero();       ///< measured in the current pair
  double disparity_px = 0.0;  ///< x_left - x_right, measured in the current pair
  Eigen::Vector3d point_cur =
      Eigen::Vector3d::Zero();  ///< triangulated, current left camera frame [m]
};

using Correspondences = std::vector<Correspondence>;

/// One flag per correspondence, in the same order: 1 if it belongs to the set, else 0.
using FeatureSet = std::vector<char>;

/// Points closer to the image plane than this [m] are projected as if they were at this depth. It
/// keeps the residual of a wrong match finite.
constexpr double kMinDepth_m = 0.1;

/// Whether a triangulated depth [m] is finite and far enough in front of the camera.
inline bool isUsableDepth(double depth_m) {
  return std::isfinite(depth_m) && depth_m >= kMinDepth_m;
}

/// Computes point_cur of all features from their disparities. Removes those without a usable depth.
void triangulate(const StereoCamera& camera, Correspondences& features);

}  // namespace rotrocc
