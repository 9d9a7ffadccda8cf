#include "odometry/rig_estimate.h"

namespace rotrocc {
namespace {

/// Smaller differences of a calibration, see StereoCamera::differenceTo(), are rounding: a
/// hundredth of a pixel of a usual camera.
constexpr double kSameCamera = 1e-5;

}  // namespace

RigEstimate::RigEstimate(const OdometryConfig& config)
    : corrects_(config.stereo_calibrator.enabled),
      calibrator_(config.stereo_calibrator, config.motion_estimator.robust_factor),
      shared_errors_(config.motion_estimator),
      row_search_(config.correspondence_finder) {}

void RigEstimate::configure(const OdometryConfig& config) {
  corrects_ = config.stereo_calibrator.enabled;
  calibrator_.configure(config.stereo_calibrator, config.motion_estimator.robust_factor);
  shared_errors_.configure(config.motion_estimator);
  row_search_ = RowSearch(config.correspondence_finder);
}

bool RigEstimate::setCamera(const StereoCamera& camera) {
  const bool is_same = camera_.differenceTo(camera) < kSameCamera;
  camera_ = camera;
  if (is_same) return true;
  calibrator_.reset();
  shared_errors_.reset();
  rows_.reset();
  time_skew_.reset();
  return false;
}

/// The row offset of the right image that is corrected, if the rig is calibrated.
double RigEstimate::correctedRows() const {
  return corrects_ ? rows_.offset().applied_px : 0.0;
}

void RigEstimate::startKeyframe(Keyframe& keyframe) {
  calibrator_.advance();
  shared_errors_.advance();
  if (!rows_.isKnown()) {
    row_search_.search(correctedCamera(), keyframe, searched_rows_px_);
    rows_.observe(searched_rows_px_);
  }
  keyframe.row_offset_px = correctedRows();
}

void RigEstimate::observe(const Hypothesis& found,
                          const Keyframe& keyframe,
                          const StereoFrame& current) {
  const FeatureSet& inliers = found.estimate.rotation_inliers;
  shared_errors_.observe(found.camera, found.features, inliers, found.estimate.T_keyframe_cur);
  if (!rows_.isKnown() && !rows_.isNear(keyframe.row_offset_px)) return;
  row_search_.measure(current, found.features, inliers, keyframe.row_offset_px, row_offsets_);
  rows_.observe(row_offsets_.offsets_px);
  time_skew_.observe(
      found.camera, found.features, row_offsets_, secondsBetween(*keyframe.frame, current));
}

void RigEstimate::report(OdometryResult& result) const {
  result.disparity_bias = calibrator_.bias();
  result.row_offset = rows_.offset();
  result.row_offset.applied_px = correctedRows();
  result.time_skew = time_skew_.skew();
}

}  // namespace rotrocc
