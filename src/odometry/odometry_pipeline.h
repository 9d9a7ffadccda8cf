#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "features/correspondence_finder.h"
#include "features/keyframe.h"
#include "features/stereo_frame.h"
#include "odometry/hypothesis.h"
#include "odometry/motion_check.h"
#include "odometry/motion_model.h"
#include "odometry/motion_search.h"
#include "odometry/rig_estimate.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// The state between pairs, and the processing stages in the order of section V.
class VisualOdometry::Pipeline {
 public:
  explicit Pipeline(const Config& config);

  /// What other sensors know of the motion, see VisualOdometry::process().
  struct OtherSensors {
    const std::optional<Eigen::Isometry3d>& T_last_cur;
    const RotationSource& rotation;
  };

  OdometryResult process(const StereoPair& pair,
                         const StereoCamera& camera,
                         const OtherSensors& others);
  void prepare();
  void reset();
  void configure(const Config& config);

  const Correspondences& correspondences() const { return found_.features; }
  const FeatureSet& rotationInliers() const { return found_.estimate.rotation_inliers; }
  const FeatureSet& translationInliers() const { return found_.estimate.translation_inliers; }

 private:
  /// Throws Lost if there is no motion.
  void advance(const StereoPair& pair,
               const StereoCamera& camera,
               const OtherSensors& others,
               OdometryResult& result);
  void forget();
  void makeKeyframe(const FramePtr& frame, StageTimes& times);

  /// What is known of the motion from the last frame, or the lost one, to the current frame.
  struct Expectation {
    double dt_s;
    std::optional<Eigen::Matrix3d> R_last_cur;    ///< as another sensor measured it
    std::optional<Eigen::Isometry3d> T_last_cur;  ///< as predicted
  };
  Expectation expectation(const StereoFrame& current, const OtherSensors& others) const;
  void findMotion(const FramePtr& current, const OtherSensors& others, OdometryResult& result);
  bool findMotionFrom(const FramePtr& earlier,
                      const StereoFrame& current,
                      const Expectation& expected,
                      StageTimes& times);
  void accept(const FramePtr& current, OdometryResult& result);

  Config config_;
  CorrespondenceFinder finder_;
  MotionModel motion_model_;
  MotionSearch search_;
  MotionCheck check_;
  RigEstimate rig_;

  FramePtr last_;      // last frame with a known pose; null before the first pair
  FramePtr lost_;      // latest frame without a motion since last_; may be null
  Keyframe keyframe_;  // no frame if it must be created from the last frame

  StageTimes prepared_;  // of prepare() since the last pair
  Hypothesis found_;
};

}  // namespace rotrocc
