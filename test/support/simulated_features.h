#pragma once

#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"
#include "simulation/kitti_camera.h"

namespace rotrocc {

/// Standard deviations of the measurements of a feature [px].
struct FeatureNoise {
  double flow_px = 0.0;  ///< in x and y
  double disparity_px = 0.0;
};

/// Measures a point of the current camera frame; fails if one of the two images does not show it,
/// or its depth is beyond what a stereo matcher finds. The noise is Gaussian; that of the flow is
/// of keyframe_px.
bool measure(const StereoCamera& camera,
             const Eigen::Vector3d& point_cur,
             const Eigen::Isometry3d& T_keyframe_cur,
             const FeatureNoise& noise,
             std::mt19937& generator,
             Correspondence& feature);

/// `count` features of the street of SyntheticScene, at random pixels of the current image, as a
/// camera that moved by `T_keyframe_cur` measures them.
Correspondences simulateFeatures(const StereoCamera& camera,
                                 const Eigen::Isometry3d& T_keyframe_cur,
                                 int count,
                                 const FeatureNoise& noise,
                                 std::mt19937& generator);

/// Gives `count` features from `first` on random matches, up to `most_px` off in x and y.
void mismatch(Correspondences& features,
              std::size_t first,
              std::size_t count,
              double most_px,
              std::mt19937& generator);

/// Puts the first `count` features on a truck 12 m ahead, which is slower by 0.3 m per pair.
void putOnTruck(Correspondences& features,
                std::size_t count,
                const Eigen::Isometry3d& T_keyframe_cur,
                const FeatureNoise& noise,
                std::mt19937& generator);

/// 400 features whose disparities are too small by error_px(pixel).
Correspondences biasedFeatures(const Eigen::Isometry3d& T_keyframe_cur,
                               unsigned seed,
                               const FeatureNoise& noise,
                               const std::function<double(const Eigen::Vector2d&)>& error_px);

/// The set of all features.
FeatureSet all(const Correspondences& features);

/// The motion with translation [m] and rotation vector [rad].
Eigen::Isometry3d motion(const Eigen::Vector3d& translation_m, const Eigen::Vector3d& rotation_rad);

/// 13 m/s in a bend, during 0.1 s.
Eigen::Isometry3d turnAhead();

/// A prediction of a motion, with an error of some centimeters and a tenth of a degree.
Eigen::Isometry3d roughly(const Eigen::Isometry3d& T_keyframe_cur);

/// The error of an estimated motion in the order of OdometryResult::covariance.
Vector6d motionError(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth);

/// Motions of a car and of a hand-held camera, some without rotation or translation.
std::vector<Eigen::Isometry3d> someMotions();

/// 20 features with that motion, and large noise.
Correspondences someFeatures(const Eigen::Isometry3d& T_keyframe_cur);

}  // namespace rotrocc
