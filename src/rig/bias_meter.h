#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "motion/reprojection_problem.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// The disparity bias that the features of one pair show.
struct BiasMeasurement {
  double bias_px = 0.0;     ///< relative to the camera that was passed
  double noise_px2 = 0.0;   ///< variance by the noise of single features
  double shared_px2 = 0.0;  ///< variance by errors that neighboring features share
  Vector6d motion_by_bias = Vector6d::Zero();  ///< translation, then rotation
};

/// Measures the disparity bias of single pairs: with biased disparities, no motion explains both
/// near and far points. The bias is one more unknown of Eq. 25, estimated together with the motion
/// and the errors that neighboring features share, see ReprojectionProblem::shareErrors(): near
/// points are at the bottom and the sides of an image, so what lenses leave there passes for a
/// bias.
class BiasMeter {
 public:
  /// Starts at the given motion, with depths as triangulated for `camera`. None if the features do
  /// not determine a bias, as at standstill.
  std::optional<BiasMeasurement> measure(const StereoCamera& camera,
                                         const Correspondences& features,
                                         const Eigen::Isometry3d& T_keyframe_cur);

 private:
  double linearize();
  std::optional<BiasMeasurement> describe(double variance_px2);

  // The current step of one measurement, reused.
  StereoCamera camera_;
  Correspondences features_;
  Eigen::Isometry3d T_keyframe_cur_ = Eigen::Isometry3d::Identity();
  ReprojectionProblem problem_;
};

}  // namespace rotrocc
