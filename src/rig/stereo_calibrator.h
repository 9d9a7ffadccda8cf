#pragma once

#include "rig/bias_filter.h"
#include "rig/bias_meter.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Rig calibration: estimates the disparity bias, a constant error of all disparities caused by an
/// inexact stereo calibration, or by a rig that moves. BiasMeter measures it in each pair,
/// BiasFilter follows it over the drive.
class StereoCalibrator {
 public:
  using Config = StereoCalibratorConfig;

  /// `robust_factor`: of cauchyWeights().
  StereoCalibrator(const Config& config, double robust_factor);

  /// Changes the parameters. The estimate is kept unless the calibration is disabled.
  void configure(const Config& config, double robust_factor);

  const DisparityBias& bias() const { return bias_; }

  /// The camera corrected by the applied bias.
  StereoCamera correct(const StereoCamera& camera) const;

  /// Adds a motion estimated from the flagged features. Their depths must be those of `corrected`,
  /// the last result of correct(). Motions from the same keyframe share its errors: only the last
  /// one counts. `shared_ratio` is that of Measurements.
  void observe(const StereoCamera& corrected,
               const Correspondences& features,
               const FeatureSet& set,
               const Eigen::Isometry3d& T_keyframe_cur,
               double shared_ratio);

  /// Covariance that the uncertainty of the bias adds to that of the last observed motion, in the
  /// order of OdometryResult::covariance.
  Matrix6d motionCovariance() const;

  /// Starts a new keyframe: the last observation becomes final.
  void advance() { past_ = filter_; }

  /// Discards the estimate, for use with another rig.
  void reset();

 private:
  void update();

  Config config_;
  BiasMeter meter_;
  BiasFilter past_;    // without the observations of the current keyframe
  BiasFilter filter_;  // with the last of them
  DisparityBias bias_;
  Vector6d motion_by_bias_ = Vector6d::Zero();  // translation, then rotation
};

}  // namespace rotrocc
