#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "features/correspondence_finder.h"
#include "motion/motion_estimator.h"
#include "odometry/keyframe_selector.h"
#include "odometry/motion_check.h"
#include "odometry/motion_model.h"
#include "rig/noise_estimator.h"
#include "rig/row_comparison.h"
#include "rig/stereo_calibrator.h"
#include "rotrocc/visual_odometry.h"

namespace rotrocc {

/// What is kept from pair to pair, and the stages in the order of section V.
class VisualOdometry::Pipeline {
 public:
  explicit Pipeline(const Config& config);

  OdometryResult process(const StereoPair& pair,
                         const StereoCamera& camera,
                         const std::optional<Eigen::Isometry3d>& expected);
  void reset();
  void configure(const Config& config);

  const Correspondences& correspondences() const { return features_; }
  const FeatureSet& rotationInliers() const { return estimate_.rotation_inliers; }
  const FeatureSet& translationInliers() const { return estimate_.translation_inliers; }

 private:
  /// Throws Lost if there is no motion.
  void advance(const StereoPair& pair,
               const StereoCamera& camera,
               const std::optional<Eigen::Isometry3d>& expected,
               OdometryResult& result);
  void checkInput(const StereoPair& pair, const StereoCamera& camera) const;
  std::string whyStart(const StereoPair& pair, const StereoCamera& camera) const;
  void takePair(const StereoPair& pair, const StereoCamera& camera, StageTimes& times);
  void startFromCurrent();
  void takeUpLost(OdometryResult& result);
  double sinceKeyframe_s() const;
  void makeKeyframeOfLast(OdometryResult& result);

  /// Both return why there is no motion, or nothing if there is one.
  std::string findMotion(const std::optional<Eigen::Isometry3d>& T_last_cur,
                         OdometryResult& result);
  std::string whyLost() const;
  void trackAndEstimate(const Eigen::Isometry3d& T_keyframe_cur,
                        bool is_prediction,
                        OdometryResult& result);
  void estimate(const Eigen::Isometry3d& T_keyframe_cur,
                bool is_prediction,
                OdometryResult& result);
  void calibrate(OdometryResult& result);

  void accept(OdometryResult& result);
  void giveUp(const std::string& why, OdometryResult& result);
  void forgetFeatures();

  Config config_;
  CorrespondenceFinder finder_;
  MotionModel motion_model_;
  MotionEstimator estimator_;
  MotionCheck check_;
  NoiseEstimator noise_;
  StereoCalibrator calibrator_;
  RowComparison rows_;
  KeyframeSelector selector_;

  StereoCamera camera_;     // as it came
  StereoCamera corrected_;  // with the bias taken out
  std::int64_t stamp_ns_ = 0;

  // The last pair whose pose is known, and one after it that is lost.
  bool has_last_ = false;
  std::int64_t last_stamp_ns_ = 0;
  bool has_lost_ = false;
  std::int64_t lost_stamp_ns_ = 0;

  bool keyframe_serves_ = false;  // for the next pair; if not, the last one becomes it
  std::int64_t keyframe_stamp_ns_ = 0;
  int keyframe_corners_ = 0;
  int keyframe_with_depth_ = 0;
  UncertainTransform T_keyframe_last_;

  Correspondences features_;
  MotionEstimator::Estimate estimate_;
  std::vector<float> row_differences_px_;
  MotionEstimator::Estimate estimate_before_;  // of calibrate(), kept for its memory
};

}  // namespace rotrocc
