#pragma once

#include <vector>

#include "features/row_search.h"
#include "features/stereo_frame.h"
#include "motion/shared_error_estimator.h"
#include "odometry/hypothesis.h"
#include "rig/row_comparison.h"
#include "rig/stereo_calibrator.h"
#include "rig/time_skew_estimator.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/rigid_motion.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// What the features of all pairs so far show of the rig: disparity bias, row offset, time skew and
/// the errors that neighbouring features share.
class RigEstimate {
 public:
  explicit RigEstimate(const OdometryConfig& config);

  /// Changes the parameters. What is estimated is kept unless it is disabled.
  void configure(const OdometryConfig& config);

  /// Discards all estimates if this is another camera, or another calibration of it. Returns
  /// whether they are kept.
  bool setCamera(const StereoCamera& camera);

  /// The camera as it was passed.
  const StereoCamera& camera() const { return camera_; }
  /// The camera corrected by the disparity bias.
  StereoCamera correctedCamera() const { return calibrator_.correct(camera_); }

  /// See Measurements.
  double sharedRatio() const { return shared_errors_.ratio(); }
  /// Covariance that the uncertainty of the rig adds to that of the last motion.
  Matrix6d motionCovariance() const { return calibrator_.motionCovariance(); }
  StereoCalibrator& calibrator() { return calibrator_; }

  /// Whether the row offset is known. Before, each keyframe adds to what is known of it.
  bool knowsRows() const { return rows_.isKnown(); }
  /// The rig may have been moved: see RowComparison::searchAgain().
  void searchRowsAgain() { rows_.searchAgain(); }

  /// Measures a new keyframe, whose corners are known, and sets its row offset.
  void startKeyframe(Keyframe& keyframe);

  /// Adds an accepted motion from the keyframe to the current frame.
  void observe(const Hypothesis& found, const Keyframe& keyframe, const StereoFrame& current);

  /// Stores the estimates, with the corrections of the next pair.
  void report(OdometryResult& result) const;

 private:
  double correctedRows() const;

  bool corrects_;
  StereoCamera camera_;
  StereoCalibrator calibrator_;
  SharedErrorEstimator shared_errors_;
  RowSearch row_search_;
  RowComparison rows_;
  TimeSkewEstimator time_skew_;
  std::vector<float> searched_rows_px_;  // buffer, reused
  RowOffsets row_offsets_;               // buffer, reused
};

}  // namespace rotrocc
