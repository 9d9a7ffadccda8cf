#pragma once

#include <cmath>
#include <vector>

#include "features/row_search.h"
#include "features/stereo_frame.h"
#include "odometry/motion_check.h"
#include "rig/bias_filter.h"
#include "rig/bias_meter.h"
#include "rig/delay_filter.h"
#include "rig/row_comparison.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What the features of all pairs so far show of the rig: the row offset, and the disparity bias, a
/// constant error of all disparities caused by an inexact stereo calibration, or by a rig that
/// moves.
class RigEstimate {
 public:
  explicit RigEstimate(const OdometryConfig& config);

  /// Changes the parameters. What is estimated is kept unless it is disabled.
  void configure(const OdometryConfig& config);

  /// Discards all estimates if this is another camera, or another calibration of it, than they
  /// began with. Returns whether they are kept.
  bool setCamera(const StereoCamera& camera);

  /// From now on, pixels refer to images halved `level` times (-1: doubled), with the given
  /// detail_px and window_scale of StereoCamera. The estimates are kept.
  void setLevel(int level, double detail_px, double window_scale);

  /// The camera of whole images.
  const StereoCamera& camera() const { return camera_; }
  /// The camera of the halved images, corrected by the disparity bias.
  StereoCamera correctedCamera() const;
  /// In pixels of the halved images.
  DisparityBias bias() const;

  /// Covariance that the uncertainty of the bias adds to that of the last motion, in the order of
  /// OdometryResult::covariance.
  Matrix6d motionCovariance() const;

  /// Whether the row offset is known. Before, each keyframe adds to what is known of it.
  bool knowsRows() const { return rows_.isKnown(); }
  /// The rig may have been moved: see RowComparison::searchAgain().
  void searchRowsAgain() { rows_.searchAgain(); }

  /// Measures a new keyframe, whose corners are known, and sets its row offset.
  void startKeyframe(Keyframe& keyframe);

  /// Measures the bias at an accepted motion, whose features have depths of correctedCamera().
  /// Motions from the same keyframe share its errors: only the last one counts. All features are
  /// used: the inliers of a motion with a wrong bias are those that agree with this bias.
  void observeBias(const Hypothesis& found);

  /// Measures the row offset and the delay of the right images at an accepted motion, from the
  /// keyframe to the current frame. At a degraded one only the delay: the flows of features that
  /// agree are right even if the motion is not.
  void observeRows(const Hypothesis& found,
                   const Keyframe& keyframe,
                   const StereoFrame& current,
                   bool is_degraded);

  /// Stores the estimates, with the corrections of the next pair, in pixels of whole images.
  void report(OdometryResult& result) const;

 private:
  double knownBias() const { return std::ldexp(config_.bias_px, -level_); }
  double correctedRows() const;
  double correctedDelay() const;
  void resetBias();

  StereoCalibratorConfig config_;
  StereoCamera camera_;
  StereoCamera first_camera_;  // of the estimates
  int level_ = 0;
  BiasMeter meter_;
  BiasFilter past_;                             // without the observations of the current keyframe
  BiasFilter filter_;                           // with the last of them
  Vector6d motion_by_bias_ = Vector6d::Zero();  // translation, then rotation
  RowSearch row_search_;
  RowComparison rows_;
  DelayFilter delay_;
  std::vector<RowSample> row_samples_;  // buffers, reused
  std::vector<float> row_offsets_px_;
};

}  // namespace rotrocc
