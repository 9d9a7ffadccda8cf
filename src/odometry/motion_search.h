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

/// Finds the motion from a keyframe to the current frame by testing hypotheses.
class MotionSearch {
 public:
  /// Throws as the constructor of MotionEstimator.
  explicit MotionSearch(const OdometryConfig& config);

  /// First tries the prediction `T_last_cur`, if there is one. Without one, or if it fails, starts
  /// from zero motion since the last frame. Features tracked from a wrong start may agree on a
  /// wrong motion, so tracking and estimation are repeated, each time starting from the last
  /// result, until the motion settles or `found` counts `most_tries`. There is at least one such
  /// try. Returns why there is no motion; empty if `found` is the motion.
  std::string find(CorrespondenceFinder& finder,
                   const StereoCamera& camera,
                   const Keyframe& keyframe,
                   const StereoFrame& current,
                   const std::optional<Eigen::Isometry3d>& T_last_cur,
                   int most_tries,
                   Hypothesis& found,
                   StageTimes& times);

  /// The features depend on the disparity bias of the rig as well as on the motion. Estimates both
  /// alternately and stores in `found` the last hypothesis that is not lost. `camera` is the camera
  /// without correction.
  void calibrate(const StereoCamera& camera,
                 double dt_s,
                 StereoCalibrator& calibrator,
                 Hypothesis& found,
                 StageTimes& times);

 private:
  /// Both return why there is no motion; empty if there is one.
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
  Hypothesis recalibrated_;  // buffer of calibrate(), reused
};

}  // namespace rotrocc
