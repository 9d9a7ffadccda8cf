#include "rig/stereo_calibrator.h"

#include "motion/shared_error.h"

namespace rotrocc {

StereoCalibrator::StereoCalibrator(const Config& config, double robust_factor)
    : config_(config), meter_(robust_factor) {
  update();
}

void StereoCalibrator::configure(const Config& config, double robust_factor) {
  config_ = config;
  meter_ = BiasMeter(robust_factor);
  if (config_.enabled) {
    update();
  } else {
    reset();
  }
}

StereoCamera StereoCalibrator::correct(const StereoCamera& camera) const {
  StereoCamera corrected = camera;
  corrected.cx_right += bias_.applied_px;
  return corrected;
}

void StereoCalibrator::observe(const StereoCamera& corrected,
                               const Correspondences& features,
                               const FeatureSet& set,
                               const Eigen::Isometry3d& T_keyframe_cur,
                               double shared_ratio) {
  if (!config_.enabled) return;
  motion_by_bias_.setZero();
  const double smooth_ratio = kSmoothShare * shared_ratio;
  auto measurement = meter_.measure(corrected, features, set, T_keyframe_cur, smooth_ratio);
  if (!measurement) return;
  motion_by_bias_ = measurement->motion_by_bias;
  measurement->bias_px += bias_.applied_px - config_.bias_px;
  filter_ = past_;
  filter_.add(*measurement);
  update();
}

Matrix6d StereoCalibrator::motionCovariance() const {
  const double left_px = bias_.estimated_px - bias_.applied_px;
  const double variance = bias_.sigma_px * bias_.sigma_px + left_px * left_px;
  return variance * motion_by_bias_ * motion_by_bias_.transpose();
}

void StereoCalibrator::reset() {
  past_ = BiasFilter();
  filter_ = past_;
  motion_by_bias_.setZero();
  update();
}

void StereoCalibrator::update() {
  bias_ = filter_.bias();
  bias_.estimated_px += config_.bias_px;
  bias_.applied_px += config_.bias_px;
}

}  // namespace rotrocc
