#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The three errors of the paper for one feature.
struct FeatureErrors {
  double reprojection_px = 0.0;  ///< RE, Eq. 2
  double normalized = 0.0;       ///< NRE: RE over the flow, Eq. 8
  double decoupled = 0.0;        ///< DNRE: RE over the flow without rotation, Eq. 24
};

/// A true motion and a wrong hypothesis of it.
struct AssumedMotion {
  std::string name;
  Eigen::Isometry3d T_keyframe_cur_true = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_keyframe_cur_assumed = Eigen::Isometry3d::Identity();
};

/// Fig. 4: pitch, yaw and roll of 3 deg, and 1 m along x, y and z, each overestimated by 10 %.
std::vector<AssumedMotion> singleAxisMotions();

/// Fig. 5: a turn of 50 deg/s with 10 deg/s of pitch and 5 deg/s of roll at 50 km/h, seen at 10 Hz;
/// the assumed rotation is right, the assumed translation 5 % too long.
AssumedMotion turnMotion();

/// Computes the errors for noise-free flow of points [m, camera frame at t]. The assumed depth of a
/// point is its true depth times its `depth_factors`; empty: all 1. Throws std::invalid_argument if
/// the sizes differ.
std::vector<FeatureErrors> judgeFeatures(const StereoCamera& camera,
                                         const std::vector<Eigen::Vector3d>& points_cur,
                                         const AssumedMotion& hypothesis,
                                         const std::vector<double>& depth_factors = {});

}  // namespace rotrocc
