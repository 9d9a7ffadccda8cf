#include "odometry/rig_estimate.h"

#include <cmath>

#include "motion/reprojection_problem.h"

namespace rotrocc {
namespace {

/// Smaller differences of a calibration, see StereoCamera::differenceTo(), are rounding: a
/// hundredth of a pixel of a usual camera.
constexpr double kSameCamera = 1e-5;

}  // namespace

RigEstimate::RigEstimate(const OdometryConfig& config)
    : config_(config.stereo_calibrator), row_search_(config.correspondence_finder) {}

void RigEstimate::configure(const OdometryConfig& config) {
  config_ = config.stereo_calibrator;
  if (!config_.enabled) resetBias();
  row_search_ = RowSearch(config.correspondence_finder);
}

bool RigEstimate::setCamera(const StereoCamera& camera) {
  camera_ = camera;
  if (first_camera_.differenceTo(camera) < kSameCamera) return true;
  first_camera_ = camera;
  resetBias();
  rows_ = {};
  delay_ = {};
  return false;
}

void RigEstimate::setLevel(int level, double detail_px, double window_scale) {
  camera_.detail_px = detail_px;
  camera_.window_scale = window_scale;
  if (level == level_) return;
  const double factor = std::ldexp(1.0, level_ - level);
  level_ = level;
  motion_by_bias_ /= factor;
  rows_.scale(factor);
}

void RigEstimate::resetBias() {
  past_ = filter_ = BiasFilter();
  motion_by_bias_.setZero();
}

StereoCamera RigEstimate::correctedCamera() const {
  StereoCamera corrected = camera_.halved(level_);
  corrected.cx_right += bias().applied_px;
  return corrected;
}

DisparityBias RigEstimate::bias() const {
  DisparityBias bias = filter_.bias(std::ldexp(camera_.fx, -level_));
  bias.estimated_px += knownBias();
  bias.applied_px += knownBias();
  return bias;
}

Matrix6d RigEstimate::motionCovariance() const {
  const DisparityBias bias = this->bias();
  const double left_px = bias.estimated_px - bias.applied_px;
  const double variance = bias.sigma_px * bias.sigma_px + left_px * left_px;
  return variance * motion_by_bias_ * motion_by_bias_.transpose();
}

/// The row offset of the right image that is corrected, if the rig is calibrated.
double RigEstimate::correctedRows() const {
  return config_.enabled ? rows_.offset().applied_px : 0.0;
}

double RigEstimate::correctedDelay() const {
  return config_.enabled ? delay_.delay().applied_s : 0.0;
}

void RigEstimate::startKeyframe(Keyframe& keyframe) {
  past_ = filter_;
  if (!rows_.isKnown()) rows_.observe(row_search_.search(correctedCamera(), keyframe));
  keyframe.row_offset_px = correctedRows();
  keyframe.right_delay_s = correctedDelay();
}

void RigEstimate::observeBias(const Hypothesis& found) {
  if (!config_.enabled) return;
  motion_by_bias_.setZero();
  auto measurement = meter_.measure(found.camera, found.features, found.estimate.T_keyframe_cur);
  if (!measurement) return;
  motion_by_bias_ = measurement->motion_by_bias;
  measurement->bias_px += bias().applied_px - knownBias();
  filter_ = past_;
  filter_.add(*measurement, found.camera.fx);
}

void RigEstimate::observeRows(const Hypothesis& found,
                              const Keyframe& keyframe,
                              const StereoFrame& current,
                              bool is_degraded) {
  const FeatureSet& inliers = found.estimate.rotation_inliers;
  if (!rows_.isKnown() && !rows_.isNear(keyframe.row_offset_px)) return;
  row_search_.measure(found.camera,
                      current,
                      found.features,
                      inliers,
                      found.estimate.T_keyframe_cur,
                      keyframe.row_offset_px,
                      row_samples_);
  const double dt_s = secondsBetween(*keyframe.frame, current);
  delay_.add(found.camera, dt_s, row_samples_);
  if (is_degraded) return;
  const double late = correctedDelay() / dt_s;
  row_offsets_px_.clear();
  for (const RowSample& sample : row_samples_) {
    row_offsets_px_.push_back(sample.offset_px - static_cast<float>(late * sample.flow_px.y()));
  }
  rows_.observe(row_offsets_px_);
}

void RigEstimate::report(OdometryResult& result) const {
  result.disparity_bias = bias();
  result.row_offset = rows_.offset();
  result.row_offset.applied_px = correctedRows();
  result.right_delay = delay_.delay();
  result.right_delay.applied_s = correctedDelay();
  for (double* px : {&result.disparity_bias.estimated_px,
                     &result.disparity_bias.sigma_px,
                     &result.disparity_bias.applied_px,
                     &result.row_offset.median_px,
                     &result.row_offset.sigma_px,
                     &result.row_offset.typical_px,
                     &result.row_offset.applied_px}) {
    *px = std::ldexp(*px, level_);
  }
}

}  // namespace rotrocc
