#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What the three criteria of the paper say of one feature.
struct FeatureErrors {
  double reprojection_px = 0.0;  ///< RE, Eq. 2
  double normalized = 0.0;       ///< NRE: RE over the flow, Eq. 8
  double decoupled = 0.0;        ///< DNRE: RE over the flow without the rotation's share, Eq. 24
};

/// A motion and the wrong idea of it that features are judged by.
struct Hypothesis {
  std::string name;
  Eigen::Isometry3d T_prev_cur_true = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_prev_cur_assumed = Eigen::Isometry3d::Identity();
};

/// Fig. 4: pitch, yaw and roll of 3 deg, and 1 m along x, y and z, each assumed to be 10 % more.
std::vector<Hypothesis> singleAxisHypotheses();

/// Fig. 5: a turn of 50 deg/s with 10 deg/s of pitch and 5 deg/s of roll at 50 km/h, seen at 10 Hz;
/// the assumed rotation is right, the assumed translation 5 % too long.
Hypothesis turnHypothesis();

/// Judges ideally measured flow of points [m, camera frame at t]. The depth that the criteria are
/// given is a point's true depth times its `depth_factors`, all 1 if that is empty.
/// Throws std::invalid_argument if the sizes differ otherwise.
std::vector<FeatureErrors> judgeFeatures(const StereoCamera& camera,
                                         const std::vector<Eigen::Vector3d>& points_cur,
                                         const Hypothesis& hypothesis,
                                         const std::vector<double>& depth_factors = {});

}  // namespace rotrocc
