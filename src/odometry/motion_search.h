#pragma once

#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "features/correspondence_finder.h"
#include "features/keyframe.h"
#include "features/stereo_frame.h"
#include "motion/motion_estimator.h"
#include "odometry/hypothesis.h"
#include "odometry/motion_check.h"
#include "rig/stereo_calibrator.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Finds the motion from a keyframe to the current frame by trying hypotheses.
class MotionSearch {
 public:
  /// Throws as MotionEstimator.
  explicit MotionSearch(const OdometryConfig& config);

  /// Tries the prediction `T_last_cur`, if there is one. Without one, or where it proves wrong,
  /// features tracked from a wrong place may agree on a wrong motion: tracks and estimates,
  /// starting from no motion, until it settles, or `found` counts `most_tries`; once at least.
  /// Returns why there is no motion, or nothing if there is one, which is `found`.
  std::string find(CorrespondenceFinder& finder,
                   const StereoCamera& camera,
                   const Keyframe& keyframe,
                   const StereoFrame& current,
                   const std::optional<Eigen::Isometry3d>& T_last_cur,
                   int most_tries,
                   Hypothesis& found,
                   StageTimes& times);

  /// The features show the rig's disparity bias as well as the motion: estimates both in turns, and
  /// leaves in `found` the last hypothesis that is not lost. `camera` is that without correction.
  void calibrate(const StereoCamera& camera,
                 double dt_s,
                 StereoCalibrator& calibrator,
                 Hypothesis& found,
                 StageTimes& times);

 private:
  /// Both return why there is no motion.
  std::string tryMotion(CorrespondenceFinder& finder,
                        const Keyframe& keyframe,
                        const StereoFrame& current,
                        const Eigen::Isometry3d& T_keyframe_cur,
                        bool is_prediction,
                        Hypothesis& found,
                        StageTimes& times);
  std::string estimate(const Eigen::Isometry3d& T_keyframe_cur,
                       bool is_prediction,
                       double dt_s,
                       Hypothesis& hypothesis);

  double settled_px_;
  MotionEstimator estimator_;
  MotionCheck check_;
  Hypothesis recalibrated_;  // of calibrate(); reused
};

}  // namespace rotrocc
