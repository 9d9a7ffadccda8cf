#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "features/correspondence_finder.h"
#include "features/keyframe.h"
#include "features/stereo_frame.h"
#include "motion/motion_estimator.h"
#include "odometry/hypothesis.h"
#include "odometry/motion_check.h"
#include "odometry/prediction_error.h"
#include "rig/stereo_calibrator.h"
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
    double shared_ratio;  ///< see Measurements
  };

  /// What is expected of the motion since the last frame, as far as known.
  struct Expectation {
    std::optional<Eigen::Isometry3d> T_last_cur;
    std::optional<Eigen::Matrix3d> R_last_cur;
  };

  /// Throws as the constructor of MotionEstimator.
  explicit MotionSearch(const OdometryConfig& config);

  /// Tracks the features from the positions that a motion predicts and estimates the motion. If the
  /// result is far from the predicted one, most features were searched at the wrong place: then
  /// they are tracked again from the result, until it settles. Starts at the expected motion,
  /// if there is one. Without one, starts at rest, turned by the expected rotation if there is one.
  /// If that does not settle, starts at rest. A start at rest since the last frame continues with
  /// the motion that most features agree on. If nothing is expected, a part of the features begins.
  ///
  /// `found` becomes the accepted hypothesis with the most inliers, or a rejected one if none is
  /// accepted. Its number of tries is added to that of `found`. There is at least one try, and none
  /// after `most_tries`.
  ///
  /// While the camera stays where it was in the keyframe, only a part of the features is searched.
  void find(const Frames& frames,
            const Expectation& expected,
            int most_tries,
            Hypothesis& found,
            StageTimes& times);

  /// Passes the found motion to the calibrator. If this changes the applied bias, estimates the
  /// motion once more, and keeps it unless it is lost. `camera` is the camera without correction.
  /// The calibrator gets all consistent features: the inliers of a motion with a wrong bias are
  /// those that agree with this bias.
  void calibrate(const StereoCamera& camera,
                 double dt_s,
                 StereoCalibrator& calibrator,
                 Hypothesis& found,
                 StageTimes& times);

  /// Forgets the quality of earlier predictions.
  void reset() { prediction_error_.reset(); }

 private:
  /// Where the features are searched, and over how many pyramid levels.
  struct Start {
    Eigen::Isometry3d T_keyframe_cur;
    int levels;
    bool is_prediction;    ///< of the motion, not only of its rotation
    bool needs_consensus;  ///< the motion may be far: the features agree on a nearer one first
  };

  void search(const Frames& frames,
              const Expectation& expected,
              int most_tries,
              Hypothesis& found,
              StageTimes& times);
  bool staysAtRest(const Frames& frames, const Start& start, Hypothesis& found, StageTimes& times);
  Start startAt(const Eigen::Isometry3d& T_keyframe_last, const Expectation& expected) const;
  void findWithoutExpectation(const Frames& frames,
                              const Start& at_rest,
                              int most_tries,
                              Hypothesis& best,
                              StageTimes& times);
  bool scout(const Frames& frames, Start& start, StageTimes& times);
  void tryFew(const Frames& frames, const Start& start, StageTimes& times);
  bool settle(
      const Frames& frames, Start start, int most_tries, Hypothesis& best, StageTimes& times);
  void tryMotion(const Frames& frames,
                 const Start& start,
                 Hypothesis& hypothesis,
                 StageTimes& times);
  void rejectUnseen(double dt_s, Hypothesis& hypothesis);
  void estimate(const Eigen::Isometry3d& T_keyframe_cur,
                bool is_prediction,
                double dt_s,
                Hypothesis& hypothesis);

  FeatureTrackerConfig tracker_;
  int least_features_;
  double settled_px_;
  MotionEstimator estimator_;
  MotionCheck check_;
  PredictionError prediction_error_;

  Keyframe few_;             // a part of the features, reused
  Hypothesis tried_;         // the latest, reused
  Hypothesis recalibrated_;  // buffers of calibrate(), reused
  FeatureSet consistent_;
};

}  // namespace rotrocc
