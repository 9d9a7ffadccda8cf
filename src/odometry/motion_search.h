#pragma once

#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "features/correspondence_finder.h"
#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "motion/motion_estimator.h"
#include "odometry/motion_check.h"
#include "odometry/rig_estimate.h"
#include "rotrocc/odometry_config.h"
#include "rotrocc/odometry_result.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Finds the motion from a keyframe to the current frame by testing hypotheses.
class MotionSearch {
 public:
  /// What the motion is measured between.
  struct Frames {
    CorrespondenceFinder& finder;
    const StereoCamera& camera;
    const Keyframe& keyframe;
    const StereoFrame& current;
    double dt_s;        ///< since the frame whose pose in the keyframe is T_keyframe_last
    StageTimes& times;  ///< to which all that is done is added
  };

  /// Where the features are searched first.
  struct Start {
    Eigen::Isometry3d T_keyframe_cur;
    bool is_prediction;  ///< of the motion, not only of its rotation
  };

  /// Throws as OdometryConfig::check().
  explicit MotionSearch(const OdometryConfig& config);

  /// Tracks the features from the positions that the start predicts, and estimates the motion. If
  /// the result is far from the start, most features were searched at the wrong place: then they
  /// are tracked again from the result, until it converges, at most three times in all. Returns
  /// whether it converged at a motion that enough features agree on: then no other start is needed.
  ///
  /// `found` becomes the hypothesis, unless it holds an accepted one with more inliers. The tries
  /// are added to those of `found`; there are none after max_tries.
  bool find(const Frames& frames, const Start& start, Hypothesis& found);

  /// A start at which the scene of the keyframe is recognized, see matchDescriptors(). None if it
  /// is not.
  std::optional<Start> recognize(const Frames& frames);

  /// Measures the disparity bias at the found motion. If this changes the applied bias, estimates
  /// the motion once more, and keeps it unless it is lost.
  void calibrate(const Frames& frames, RigEstimate& rig, Hypothesis& found);

 private:
  /// Whether a quarter of the keyframe's features agree on a motion; more at rest.
  bool hasMinimumSupport(const Hypothesis& found);

  /// Whether to prefer hypothesis `a`.
  bool isBetter(const Hypothesis& a, const Hypothesis& b);
  void tryMotion(const Frames& frames,
                 const Start& start,
                 const std::optional<Eigen::Isometry3d>& prediction,
                 Hypothesis& hypothesis);
  void estimate(const Frames& frames,
                const Eigen::Isometry3d& initial,
                const std::optional<Eigen::Isometry3d>& prediction,
                Hypothesis& hypothesis);

  int window_radius_px_;
  int max_tries_;
  std::unique_ptr<MotionEstimator> estimator_;
  MotionCheck check_;
  StereoMatcher matcher_;

  Hypothesis tried_;         // the latest, reused
  Hypothesis recalibrated_;  // buffer of calibrate(), reused
};

}  // namespace rotrocc
